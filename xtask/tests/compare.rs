//! What a comparison makes of its measurements, with cases worked out by hand. Nothing here is timed.

use std::collections::BTreeMap;
use std::ffi::OsString;

use anyhow::bail;
use xtask::compare::{
    Answer, Check, Pictures, Plan, Ratio, Row, Subject, breakout, compare_values, cpu_model, in_turns, median, missed,
    motion_goal, parse_answer, perception_cases, quantile, replace_section, table, texture, widest_vectors,
};

type TestResult = anyhow::Result<()>;

fn near(got: f64, expected: f64) -> bool {
    (got - expected).abs() < 1e-12
}

#[test]
fn a_median_is_the_middle_or_between_the_two_in_the_middle() {
    assert_eq!(median(&[3.0]), 3.0);
    assert_eq!(median(&[9.0, 1.0, 4.0]), 4.0);
    assert_eq!(median(&[8.0, 1.0, 2.0, 4.0]), 3.0);
    assert!(median(&[]).is_nan());
}

#[test]
fn a_quantile_lies_on_the_line_between_its_neighbours() {
    let values = [40.0, 10.0, 20.0, 30.0];
    assert_eq!([0.0, 1.0].map(|at| quantile(&values, at)), [10.0, 40.0]);
    // A quarter of the way from the first to the fourth is three quarters from the first to the second.
    assert!(near(quantile(&values, 0.25), 17.5));
    assert!(near(quantile(&values, 0.75), 32.5));
}

#[test]
fn ratios_are_of_pairs_and_not_of_medians() {
    // 4/2, 3/3, 20/1: the medians alone would give 4/2.
    let ratio = Ratio::of(&[2.0, 3.0, 1.0], &[4.0, 3.0, 20.0]);
    assert_eq!(ratio.median, 2.0);
    assert_eq!(ratio.all, [1.0, 20.0]);
    assert_eq!(ratio.middle_half, [1.5, 11.0]);
    // 1/4, 8/2: between the two is 2.125, while both medians are 3 and 4.5.
    assert!(near(Ratio::of(&[4.0, 2.0], &[1.0, 8.0]).median, 2.125));
}

#[test]
fn both_sides_work_equally_long() {
    // In batches of 2 ms, 101 times.
    assert_eq!(Plan::new([1e5, 1e6]), Plan { turns: [20, 2], rounds: 101 });
    // As long as the longer turn: 40 ms, which fit 25 times into a second.
    assert_eq!(Plan::new([4e7, 1e7]), Plan { turns: [1, 4], rounds: 25 });
    assert_eq!(Plan::new([1e9, 3e8]), Plan { turns: [1, 3], rounds: 21 });
    assert_eq!(Plan::new([0.0, 2e6]), Plan { turns: [1_000_000, 1], rounds: 101 });
}

#[test]
fn sides_take_turns() -> TestResult {
    let mut asked = Vec::new();
    let samples = in_turns(2, |side| {
        asked.push(side);
        Ok((10 * side + asked.len()) as f64)
    })?;
    assert_eq!(asked, [0, 1, 1, 0]);
    assert_eq!(samples, [[1.0, 4.0], [12.0, 13.0]]);
    assert!(in_turns(3, |_| bail!("a worker died")).is_err());
    Ok(())
}

#[test]
fn answers_of_workers() -> TestResult {
    assert_eq!(parse_answer("{\"calls\": 24, \"ns\": 1200}\n")?, Answer::Time { calls: 24, ns: 1200 });
    assert_eq!(parse_answer("{\"values\":7}")?, Answer::Result { values: 7 });
    let versions = BTreeMap::from([("OpenCV".to_owned(), "5.0.0".to_owned())]);
    assert_eq!(parse_answer("{\"versions\": {\"OpenCV\": \"5.0.0\"}}")?, Answer::Versions(versions));
    for line in ["", "Traceback", "{}", "{\"calls\": 3}", "{\"calls\": 3, \"ns\": -1}", "[1]"] {
        assert!(parse_answer(line).is_err(), "{line}");
    }
    Ok(())
}

#[test]
fn results_that_agree_and_results_that_do_not() {
    let within = Check::Within(1e-4);
    let agree = |check, ours: &[f32], theirs: &[f32]| compare_values(check, ours, theirs).is_ok();
    assert!(agree(within, &[0.5, 1.0], &[0.50009, 1.0]));
    assert!(!agree(within, &[0.5, 1.0], &[0.5002, 1.0]));
    assert!(!agree(within, &[f32::NAN], &[f32::NAN]));
    assert!(agree(Check::Bits, &[0.5], &[0.5]));
    assert!(!agree(Check::Bits, &[0.5], &[0.500_000_06]));
    assert!(agree(Check::Count, &[0.5], &[9.0]));
    for check in [within, Check::Bits, Check::Count] {
        assert!(!agree(check, &[0.5], &[0.5, 0.5]));
        assert!(!agree(check, &[], &[]));
    }
    let error = compare_values(within, &[0.5, 1.0, 2.0], &[0.5, 1.5, 2.5]).expect_err("they differ").to_string();
    assert!(error.starts_with("value 1 is 1 with us and 1.5 there"), "{error}");
}

fn row(group: &'static str, title: &str, median: f64, target: Option<f64>) -> Row {
    Row {
        group: group.to_owned(),
        title: title.to_owned(),
        peer: "OpenCV".to_owned(),
        ours_ns: 1_234.0,
        theirs_ns: 99_960.0,
        ratio: Ratio { median, middle_half: [1.0, 3.5], all: [0.25, 7.0] },
        target,
    }
}

#[test]
fn tables_have_a_heading_for_each_group() {
    let rows =
        [row("HOG", "64×64", 3.0, Some(3.0)), row("HOG", "8×8", 2.999, Some(3.0)), row("Motion", "1×1", 2.0, None)];
    let head = "| Work | prf, µs | Peer | Peer, µs | Times faster | Half of the rounds | All rounds | Target |\n\
                |---|---|---|---|---|---|---|---|\n";
    let expected = format!(
        "### HOG\n\n{head}\
         | 64×64 | 1.23 | OpenCV | 100 | **3.00** | 1.00 … 3.50 | 0.25 … 7.00 | ≥ 3: met |\n\
         | 8×8 | 1.23 | OpenCV | 100 | **3.00** | 1.00 … 3.50 | 0.25 … 7.00 | ≥ 3: **missed** |\n\
         \n### Motion\n\n{head}\
         | 1×1 | 1.23 | OpenCV | 100 | **2.00** | 1.00 … 3.50 | 0.25 … 7.00 | – |\n"
    );
    assert_eq!(table(&rows), expected);
}

#[test]
fn missed_targets_are_counted() {
    let (met, free) = (row("HOG", "64×64", 3.0, Some(3.0)), row("HOG", "8×8", 0.5, None));
    assert_eq!(missed(&[met.clone(), free.clone()]), "Targets met: HOG 1 of 1.");
    let [slow, fast] = [1.4, 1.5].map(|median| row("Matching", "84×84", median, Some(1.5)));
    let said = missed(&[met, free, slow.clone(), fast, slow]);
    assert_eq!(said, "Targets met: HOG 1 of 1, Matching 1 of 3 (**2 missed**).");
}

#[test]
fn only_the_section_between_the_comments_is_replaced() -> TestResult {
    let text = "# Title\n\n<!-- begin: written by cargo xtask compare -->\nold\n<!-- end -->\n\nby hand <!-- end -->\n";
    let once = replace_section(text, "new\n")?;
    let begin = "<!-- begin: written by cargo xtask compare -->";
    assert_eq!(once, format!("# Title\n\n{begin}\n\nnew\n\n<!-- end -->\n\nby hand <!-- end -->\n"));
    assert_eq!(replace_section(&once, "new")?, once);
    for bad in ["no comment", "<!-- end -->", begin] {
        assert!(replace_section(bad, "new").is_err(), "{bad}");
    }
    Ok(())
}

#[test]
fn the_processor_by_its_name_and_vectors() {
    let cpuinfo =
        "processor\t: 0\nmodel\t\t: 17\nmodel name\t: Some CPU\nflags\t\t: fpu avx2 avx512bw\n\nmodel name\t: Other\n";
    assert_eq!(cpu_model(cpuinfo), Some("Some CPU"));
    assert_eq!(widest_vectors(cpuinfo), Some("AVX-512"));
    assert_eq!(widest_vectors("flags : sse2 avx2\n"), Some("AVX2"));
    assert_eq!((cpu_model(""), widest_vectors("flags : avx2x\n")), (None, None));
}

#[test]
fn words_behind_compare() {
    let parse = |words: &[&str]| Subject::parse(&words.iter().map(OsString::from).collect::<Vec<_>>());
    assert_eq!(parse(&[]), Some(Subject::Perception));
    assert_eq!(parse(&["perception"]), Some(Subject::Perception));
    assert_eq!(parse(&["perceptions"]), None);
    assert_eq!(parse(&["perception", "now"]), None);
}

#[test]
fn pictures_are_the_same_at_every_run_and_not_alike_within_one() {
    for draw in [texture, breakout] {
        let pictures = draw(84, 60, 3);
        assert_eq!(pictures, draw(84, 60, 3));
        assert_eq!((pictures.count(), pictures.pixels.len()), (3, 3 * 84 * 60));
        let frames: Vec<&[u8]> = pictures.pixels.chunks(84 * 60).collect();
        assert!(frames[0] != frames[1] && frames[1] != frames[2]);
    }
    assert!(texture(20, 20, 1).pixels.iter().all(|&pixel| pixel > 0));
    let black = breakout(84, 84, 1).pixels.iter().filter(|&&pixel| pixel == 0).count();
    assert!((84 * 42..84 * 80).contains(&black), "{black}");
}

#[test]
fn a_part_of_a_picture() {
    let pictures = Pictures::new(4, 3, 2, |x, y, t| (10 * y + x + 100 * t) as u8);
    assert_eq!(pictures.part(1, 1, 2, 2), Pictures { width: 2, height: 2, pixels: vec![11, 12, 21, 22] });
}

#[test]
fn what_moved_last_is_brightest_in_a_goal() {
    // Four pictures of four pixels: one never moves, one too little, one at the first change, one at all three.
    let pixels = vec![0, 0, 0, 0, 0, 30, 31, 90, 0, 60, 31, 0, 0, 90, 31, 90];
    let goal = motion_goal(&Pictures { width: 4, height: 1, pixels });
    assert_eq!(goal.pixels, [0, 0, 85, 255]);
}

#[test]
fn cases_have_names_of_their_own_and_at_least_one_target() {
    let (cases, _) = perception_cases();
    let mut names: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
    assert!(names.iter().all(|name| !name.contains(' ')));
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), cases.len());
    for case in &cases {
        assert_eq!(case.work["name"], case.name.as_str());
        assert_eq!(case.peers.iter().filter(|peer| peer.target.is_some()).count(), 1, "{}", case.name);
    }
}
