//! `prf score --plot`, run as a user runs it.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use predicates::prelude::*;
use predicates::str::{contains, is_empty};
use tempfile::TempDir;

use super::common::prf;
use super::pictures;

/// A folder with an all-black `goal.png`, and `frames` of pictures with 1 to 9 bars, of which the third is broken.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    pictures::flat(&folder.path().join("goal.png"), 0);
    fs::create_dir(folder.path().join("frames")).expect("the folder is ours");
    for count in 1..10 {
        pictures::bars(&folder.path().join(format!("frames/{count}.png")), count);
    }
    write(&folder, "frames/3.png", b"broken");
    folder
}

fn write(folder: &TempDir, name: &str, content: &[u8]) {
    fs::write(folder.path().join(name), content).expect("the folder is ours");
}

/// A video of 10 frames a second with `count` frames of noise, the later the less of it.
fn video(folder: &TempDir, name: &str, count: usize) {
    let mut bytes = b"YUV4MPEG2 W24 H24 F10:1 Ip A1:1 Cmono XCOLORRANGE=FULL\n".to_vec();
    for frame in 0..count {
        bytes.extend(b"FRAME\n");
        let noise = |i: usize| ((frame * 576 + i) * 2_654_435_761) >> 7;
        let lit = |i: usize| i == 0 || i == 575 || noise(i) % count > frame;
        bytes.extend((0..576).map(|i| if lit(i) { 200 } else { 0 }));
    }
    write(folder, name, &bytes);
}

/// An SVG that was drawn, taken apart.
struct Drawn {
    texts: Vec<String>,
    /// The lines of a curve's colour, those in the legend included: colour and points.
    lines: Vec<(String, Vec<(i32, i32)>)>,
    dots: Vec<String>,
    height: i32,
}

impl Drawn {
    /// Reads an SVG, which has to be XML.
    fn read(path: &Path) -> Drawn {
        let text = fs::read_to_string(path).expect("it was drawn");
        let svg = roxmltree::Document::parse(&text).expect("it is XML");
        let named =
            |name| svg.descendants().filter(move |node| node.has_tag_name(("http://www.w3.org/2000/svg", name)));
        let colour = |node: &roxmltree::Node<'_, '_>, name| node.attribute(name).unwrap_or_default().to_owned();
        let number = |text: &str| text.parse().expect("a whole number");
        let point = |pair: &str| pair.split_once(',').map(|(x, y)| (number(x), number(y))).expect("a pair");
        let points = |line: &roxmltree::Node<'_, '_>| {
            line.attribute("points").expect("a line has points").split_whitespace().map(point).collect()
        };
        let is_curve = |(colour, _): &(String, Vec<_>)| is_coloured(colour);
        let view = svg.root_element().attribute("viewBox").expect("an SVG has a size");
        let height = number(view.rsplit(' ').next().expect("four numbers"));
        Drawn {
            texts: named("text").map(|text| text.text().unwrap_or_default().trim().to_owned()).collect(),
            lines: named("polyline").map(|line| (colour(&line, "stroke"), points(&line))).filter(is_curve).collect(),
            dots: named("circle").map(|dot| colour(&dot, "fill")).collect(),
            height,
        }
    }

    fn says(&self, words: &str) -> bool {
        self.texts.iter().any(|text| text == words)
    }

    /// The lines of the curves, but for dashed ones, without the samples of the legend.
    fn curves(&self) -> impl Iterator<Item = &(String, Vec<(i32, i32)>)> {
        let is_sample = |points: &[(i32, i32)]| points.len() == 2 && points[1] == (points[0].0 + 56, points[0].1);
        self.lines.iter().filter(move |(_, points)| !is_sample(points))
    }
}

/// The axes and the grid are grey.
fn is_coloured(hex: &str) -> bool {
    hex.len() == 7 && (hex[1..3] != hex[3..5] || hex[3..5] != hex[5..7])
}

fn plot(folder: &TempDir, args: &[&str], code: i32) -> Drawn {
    prf(folder.path()).args(["score", "--plot", "plot.svg"]).args(args).assert().code(code);
    Drawn::read(&folder.path().join("plot.svg"))
}

#[test]
fn each_source_is_a_curve_of_its_own_colour() {
    let folder = folder();
    for (name, count) in [("a.y4m", 30), ("b.y4m", 20), ("c.y4m", 10)] {
        video(&folder, name, count);
    }
    let drawn = plot(&folder, &["goal.png", "a.y4m", "b.y4m", "c.y4m"], 0);
    let colours: BTreeSet<&str> = drawn.curves().map(|(colour, _)| colour.as_str()).collect();
    assert_eq!((drawn.curves().count(), colours.len()), (3, 3));
    let lengths: Vec<usize> = drawn.curves().map(|(_, points)| points.len()).collect();
    assert_eq!(lengths, [30, 20, 10]);
    // The picture's y goes down, the reward up.
    let (_, first) = drawn.curves().next().expect("three of them");
    assert!(first[29].1 < first[0].1, "{first:?}");
    for words in ["a.y4m", "b.y4m", "c.y4m", "time (s)", "reward F", "Reward for the goal goal.png"] {
        assert!(drawn.says(words), "{words}: {:?}", drawn.texts);
    }
    assert!(drawn.says("direct descriptor, 60 frames"), "{:?}", drawn.texts);
}

#[test]
fn frames_that_cannot_be_read_are_gaps() {
    let folder = folder();
    let drawn = plot(&folder, &["goal.png", "frames"], 3);
    let lengths: Vec<usize> = drawn.curves().map(|(_, points)| points.len()).collect();
    assert_eq!(lengths, [2, 6]);
    assert!(drawn.says("frame") && drawn.says("direct descriptor, 8 frames, 1 could not be scored"));
    // Evenly spaced, the broken one included.
    let x: Vec<i32> = drawn.curves().flat_map(|(_, points)| points.iter().map(|point| point.0)).collect();
    assert!((x[2] - x[1] - 2 * (x[1] - x[0])).abs() <= 1, "{x:?}");
}

#[test]
fn a_picture_alone_is_a_point_and_several_are_a_curve() {
    let folder = folder();
    let one = plot(&folder, &["goal.png", "frames/5.png"], 0);
    // One in the diagram and one in the legend.
    assert_eq!((one.curves().count(), one.dots.len()), (0, 2));
    assert!(one.says("frames/5.png") && one.says("frame") && one.says("direct descriptor, 1 frame"));

    let names = ["goal.png", "frames/1.png", "frames/2.png", "missing.png", "frames/4.png"];
    let several = plot(&folder, &names, 3);
    assert_eq!((several.curves().count(), several.dots.len()), (1, 4));
    assert!(several.says("3 pictures"), "{:?}", several.texts);

    // One that is lost keeps its place, also before all others: frames 0 to 3 have marks.
    for names in [
        ["frames/1.png", "missing.png", "frames/2.png", "frames/4.png"],
        ["missing.png", "frames/1.png", "frames/2.png", "frames/4.png"],
    ] {
        let drawn = plot(&folder, &[&["goal.png"][..], &names].concat(), 3);
        assert!(
            drawn.texts.iter().any(|text| text == "3") && !drawn.texts.iter().any(|text| text == "4"),
            "{:?}",
            drawn.texts
        );
    }
}

#[test]
fn time_is_told_only_where_all_frames_have_one() {
    let folder = folder();
    video(&folder, "a.y4m", 30);
    assert!(plot(&folder, &["goal.png", "a.y4m", "frames/5.png"], 0).says("time (s)"));
    assert!(plot(&folder, &["goal.png", "a.y4m", "frames"], 3).says("frame"));
}

#[test]
fn names_of_any_kind_stay_text() {
    let folder = folder();
    let goal = "<&>\"' goal.png";
    fs::copy(folder.path().join("goal.png"), folder.path().join(goal)).expect("the folder is ours");
    video(&folder, "a]]><b>&amp;.y4m", 5);
    let long = format!("{}.y4m", "very_long_".repeat(20));
    video(&folder, &long, 5);
    let drawn = plot(&folder, &[goal, "a]]><b>&amp;.y4m", &long], 0);
    assert!(drawn.says(&format!("Reward for the goal {goal}")), "{:?}", drawn.texts);
    assert!(drawn.says("a]]><b>&amp;.y4m"));
    let shortened = |text: &&String| text.starts_with("very_long_") && text.ends_with("long_.y4m");
    let found = drawn.texts.iter().find(shortened).expect("the long one has both ends");
    assert!(found.contains('…') && found.len() < long.len(), "{found}");
}

#[cfg(target_os = "linux")]
#[test]
fn names_that_no_xml_may_hold_are_drawn_too() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt as _;

    let folder = folder();
    let name = OsStr::from_bytes(b"a\x01\n\xff.png");
    fs::copy(folder.path().join("frames/1.png"), folder.path().join(name)).expect("Linux takes any name");
    prf(folder.path()).args(["score", "goal.png", "--plot", "plot.svg"].map(OsStr::new)).arg(name).assert().success();
    assert!(Drawn::read(&folder.path().join("plot.svg")).says("a\u{fffd}\u{fffd}\u{fffd}.png"));
}

#[test]
fn thousands_of_frames_make_no_giant_file() {
    let folder = folder();
    video(&folder, "long.y4m", 5000);
    let drawn = plot(&folder, &["goal.png", "long.y4m"], 0);
    assert_eq!(drawn.curves().count(), 1);
    let size = fs::metadata(folder.path().join("plot.svg")).expect("it is there").len();
    assert!(size < 100_000, "{size} bytes");
}

#[test]
fn more_sources_than_can_be_told_apart_are_drawn_all_the_same() {
    let folder = folder();
    let names: Vec<String> = (0..25).map(|i| format!("{i}.y4m")).collect();
    names.iter().for_each(|name| video(&folder, name, 4));
    let args: Vec<&str> = std::iter::once("goal.png").chain(names.iter().map(String::as_str)).collect();
    let drawn = plot(&folder, &args, 0);
    assert!(drawn.says("20.y4m") && !drawn.says("21.y4m") && drawn.says("and 4 more"), "{:?}", drawn.texts);
    assert_eq!(drawn.dots.len(), 21 + 25 * 4);
    assert!(drawn.height > plot(&folder, &["goal.png", "0.y4m"], 0).height);
}

#[test]
fn rewards_that_are_all_equal_or_tiny_have_axes_too() {
    let folder = folder();
    let equal = plot(&folder, &["goal.png", "goal.png", "goal.png"], 0);
    assert!(equal.says("1.000") && equal.curves().count() == 1, "{:?}", equal.texts);
    let pictures = ["goal.png", "frames/5.png", "frames/6.png", "--scale", "none", "--cell-px", "1"];
    let tiny = plot(&folder, &pictures, 0);
    assert!(tiny.texts.iter().any(|text| text.contains("e-")), "{:?}", tiny.texts);
}

#[test]
fn a_plot_and_an_explanation_are_drawn_together() {
    let folder = folder();
    prf(folder.path())
        .args(["score", "goal.png", "frames/1.png", "frames/2.png", "--plot", "new/a.svg", "--explain", "new/a.png"])
        .args(["--format", "json"])
        .assert()
        .success()
        .stdout(contains("\"reward\"").count(2))
        .stderr(contains("drew the rewards of 2 frames into new/a.svg").and(contains("into new/a.png")));
    assert!(folder.path().join("new/a.png").exists() && folder.path().join("new/a.svg").exists());
}

#[test]
fn nothing_is_written_when_nothing_could_be_scored() {
    let folder = folder();
    prf(folder.path())
        .args(["score", "goal.png", "frames/3.png", "missing.png", "--plot", "plot.svg"])
        .assert()
        .code(1)
        .stdout(is_empty());
    assert!(!folder.path().join("plot.svg").exists());
}

#[test]
fn a_plot_under_another_ending_is_misuse() {
    let folder = folder();
    for name in ["plot.png", "plot", "svg"] {
        prf(folder.path())
            .args(["score", "goal.png", "frames/1.png", "--plot", name])
            .assert()
            .code(2)
            .stdout(is_empty())
            .stderr(contains("ends in .svg"));
        assert!(!folder.path().join(name).exists());
    }
}

#[test]
fn a_plot_that_cannot_be_written_is_a_failure() {
    let folder = folder();
    fs::create_dir(folder.path().join("plot.svg")).expect("the folder is ours");
    let score = |plot| {
        prf(folder.path())
            .args(["score", "goal.png", "frames/1.png", "--plot", plot])
            .assert()
            .code(1)
            .stdout(contains("reward"))
            .stderr(contains(format!("cannot write {plot}")).and(contains("hint:")));
    };
    score("plot.svg");
    score("goal.png/plot.svg");
    let left: Vec<_> = fs::read_dir(folder.path()).expect("it is there").flatten().collect();
    assert_eq!(left.len(), 3, "no unfinished file stays: {left:?}");
}
