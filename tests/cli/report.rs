//! `prf report` as a user runs it.

use std::fs;
use std::path::Path;

use predicates::prelude::*;
use predicates::str::contains;
use scraper::{Html, Selector};
use tempfile::TempDir;

mod common;
mod run_folders;

use common::prf;
use run_folders::{CONFIG, make_run, save};

/// Small in every respect, yet with an agent that can play.
const PERCEPTUAL: &str = "\
[env]
name = \"breakout\"
limit_steps = 40
[reward]
source = \"perceptual\"
descriptor = \"direct\"
goal = \"black.png\"
[train]
steps = 240
environments = 4
batch_size = 8
replay_steps = 400
learning_starts = 100
steps_per_update = 50
threads = 1
[evaluation]
every_episodes = 8
episodes = 3
";

/// A folder with a run that was trained.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    image::GrayImage::new(84, 84).save(folder.path().join("black.png")).expect("the folder is ours");
    fs::write(folder.path().join("c.toml"), PERCEPTUAL).expect("the folder is ours");
    prf(folder.path()).args(["train", "c.toml", "--out", "ball-<1>"]).assert().success();
    folder
}

fn report(folder: &Path, args: &[&str]) -> assert_cmd::assert::Assert {
    prf(folder).arg("report").args(args).assert()
}

fn page(path: &Path) -> Html {
    let text = fs::read_to_string(path).expect("it was written");
    let page = Html::parse_document(&text);
    assert_eq!(page.errors, Vec::<String>::new(), "it is not well formed");
    check_that_it_needs_nothing(&page, &text);
    page
}

/// No attribute and no style names a file, and no script is there.
fn check_that_it_needs_nothing(page: &Html, text: &str) {
    for element in page.root_element().descendent_elements() {
        assert!(
            !["script", "iframe", "object", "embed", "base"].contains(&element.value().name()),
            "{}",
            element.html()
        );
        for (name, value) in element.value().attrs() {
            assert!(!name.starts_with("on"), "{name} is a script");
            if ["src", "srcset", "href", "xlink:href", "poster", "data", "action"].contains(&name) {
                assert!(value.starts_with("data:"), "{name}={value}");
            }
        }
    }
    for word in ["url(", "@import", "http-equiv=\"refresh\""] {
        assert!(!text.contains(word), "{word} fetches something");
    }
    assert!(text.contains("default-src 'none'"));
}

fn texts(page: &Html, selector: &str) -> Vec<String> {
    let selector = Selector::parse(selector).expect("it is a selector");
    page.select(&selector).map(|element| element.text().collect::<String>()).collect()
}

fn attributes(page: &Html, selector: &str, name: &str) -> Vec<String> {
    let selector = Selector::parse(selector).expect("it is a selector");
    page.select(&selector).filter_map(|element| element.attr(name).map(str::to_owned)).collect()
}

#[test]
fn a_page_tells_and_shows_a_run() {
    let folder = folder();
    report(folder.path(), &["ball-<1>"])
        .success()
        .stdout(contains("after 240 steps the agent scores"))
        .stderr(contains("wrote report.html"));
    let page = page(&folder.path().join("report.html"));
    assert_eq!(texts(&page, "h1"), ["breakout: a report of 1 run"]);
    assert_eq!(texts(&page, "td").first().map(String::as_str), Some("ball-<1>"));
    assert_eq!(texts(&page, "svg").len(), 2, "curves for large and for small screens");
    let claims = texts(&page, ".claims li");
    assert_eq!(claims.len(), 6);
    assert!(claims[0].contains("Every run has come to its end. holds.") && claims[0].contains("1 of 1"), "{claims:?}");
    // After so few steps it is far from the best player, and the page says so.
    assert!(claims[2].contains("does not hold."), "{claims:?}");
    assert!(texts(&page, "dd").iter().any(|fact| fact.contains("core")), "the machine is missing");
    assert!(texts(&page, "pre")[0].contains("every_episodes = 8"));

    // The goal, the agent playing, three frames of each kind, and three pictures of what was compared in two of them.
    let pictures = attributes(&page, "img", "src");
    let (moving, still): (Vec<&String>, Vec<&String>) =
        pictures.iter().partition(|uri| uri.starts_with("data:image/gif"));
    assert_eq!((moving.len(), still.len()), (1, 1 + 2 * 3 + 2 * 3));
    assert!(attributes(&page, "img", "alt").iter().all(|alt| !alt.is_empty()));
    let rewards: Vec<f32> =
        texts(&page, ".frames strong").iter().filter_map(|words| words.strip_prefix("F = ")?.parse().ok()).collect();
    let [best @ .., _, _, _] = rewards.as_slice() else { panic!("{rewards:?}") };
    let worst = &rewards[3..];
    assert!(best.is_sorted_by(|a, b| a >= b) && worst.is_sorted() && best[0] > worst[0], "{rewards:?}");
}

#[test]
fn groups_have_chapters_and_what_is_missing_is_said() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let scores: &[(u64, f64)] = &[(100, 0.0), (200, 1.0), (300, 2.0)];
    make_run(folder.path(), "ball-1", (1, CONFIG), scores);
    make_run(folder.path(), "ball-2", (2, CONFIG), scores);
    make_run(folder.path(), "fast-1", (1, &format!("{CONFIG}gamma = 0.9\n")), &[]);
    report(folder.path(), &["ball-1", "ball-2", "fast-1", "-o", "pages/all.html"])
        .success()
        .stdout(contains("gamma = 0.99: after 300 steps the agent scores 2.00 ± 0.00 over 2 seeds"))
        .stdout(contains("gamma = 0.9: nothing is evaluated yet."));
    let page = page(&folder.path().join("pages/all.html"));
    assert_eq!(texts(&page, ".chapter > h2"), ["gamma = 0.99", "gamma = 0.9"]);
    assert_eq!(
        texts(&page, ".chapter").iter().filter(|text| text.contains("No run has saved an agent yet")).count(),
        2
    );
}

#[test]
fn a_broken_model_costs_the_picture_and_not_the_page() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    save(&make_run(folder.path(), "ball", (1, CONFIG), &[(100, 0.0)]), 100, false);
    report(folder.path(), &["ball"])
        .code(3)
        .stderr(contains("the agent is not shown playing").and(contains("model.safetensors")));
    let page = page(&folder.path().join("report.html"));
    assert!(texts(&page, ".problem")[0].contains("model.safetensors"));
    report(folder.path(), &["ball", "--out", "page.txt"]).code(2).stderr(contains("ends in .html"));
}
