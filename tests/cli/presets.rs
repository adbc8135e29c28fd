//! The goals and configs that come with `prf`: goals are what their commands make, and rewards are as good as the docs say.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

mod common;

use common::prf;

fn configs() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../configs")
}

fn same_bytes(made: &Path, committed: &str) {
    let read = |path: &Path| fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let committed = configs().join("goals").join(committed);
    assert!(read(made) == read(&committed), "{} is not what its command makes", committed.display());
}

#[test]
fn flappys_goal_is_cut_out_of_a_screenshot_of_the_world() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let play = ["play", "flappy", "--player", "oracle", "--steps", "83", "--frames", "frames"];
    prf(folder.path()).args(play).assert().success();
    same_bytes(&folder.path().join("frames/0083.png"), "flappy-screen.png");
    let crop = ["goal", "crop", "frames/0083.png", "--rect", "17,40,12,32", "--out", "flappy.png"];
    prf(folder.path()).args(crop).assert().success();
    same_bytes(&folder.path().join("flappy.png"), "flappy.png");
}

#[test]
fn the_faces_goals_are_the_oracles_episodes() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    for world in ["kobian-happy", "kobian-surprise"] {
        let gif = format!("{world}.gif");
        let play = ["play", world, "--player", "oracle", "--gif", &gif, "--scale", "1"];
        prf(folder.path()).args(play).assert().success();
        same_bytes(&folder.path().join(&gif), &gif);
    }
    let play = ["play", "kobian-happy", "--player", "oracle", "--frames", "frames"];
    prf(folder.path()).args(play).assert().success();
    same_bytes(&folder.path().join("frames/0010.png"), "kobian-happy.png");
}

/// A figure of `prf inspect` on a config, with the changes that `options` make.
fn figure(config: &str, key: &str, options: &[&str]) -> f64 {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let mut inspect = prf(folder.path());
    inspect.arg("inspect").arg(configs().join(config)).args(["--format", "json"]).args(options);
    let output = inspect.assert().success().get_output().stdout.clone();
    let record: Value = serde_json::from_slice(&output).expect("one JSON object");
    record[key].as_f64().unwrap_or_else(|| panic!("no {key} in {record}"))
}

/// The paper's cell and the usual norm punish being between the pipes; what `prf tune` found rewards it.
#[test]
fn flappys_reward_orders_what_players_see() {
    assert!(figure("flappy.toml", "success_auc", &[]) >= 0.9);
    assert!(figure("flappy.toml", "rank_correlation", &[]) >= 0.8);
    let screen = configs().join("goals/flappy-screen.png");
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let crop = ["--rect", "13,40,20,32", "--out", "wide.png"];
    prf(folder.path()).args(["goal", "crop"]).arg(screen).args(crop).assert().success();
    let config = fs::read_to_string(configs().join("flappy.toml")).expect("it is committed");
    let naive = config
        .replace("goals/flappy.png", "wide.png")
        .replace("norm = \"none\"", "norm = \"l2\"")
        .replace("fraction = 0.4", "fraction = 0.1");
    let path = folder.path().join("naive.toml");
    fs::write(&path, naive).expect("the folder is ours");
    let naive = path.display().to_string();
    assert!(figure(&naive, "success_auc", &["--method", "ccorr-normed"]) < 0.3, "punished");
    assert!(figure(&naive, "success_auc", &[]) < 0.6, "not told apart");
}

#[test]
fn rewards_of_motion_order_faces_by_how_near_they_are() {
    for face in ["happy", "surprise"] {
        for goal in ["kprf", "hprf"] {
            let config = format!("kobian-{face}-{goal}.toml");
            let (rank, auc) = (figure(&config, "rank_correlation", &[]), figure(&config, "success_auc", &[]));
            assert!(rank >= 0.7 && auc >= 0.85, "{config}: {rank}, {auc}");
        }
        let paper = ["--cell", "0.05", "--norm", "l2", "--block-cells", "1"];
        let rank = figure(&format!("kobian-{face}-hprf.toml"), "rank_correlation", &paper);
        assert!(rank < 0.5, "the paper's cell is worse with a person's movement: {rank}");
    }
}
