//! `prf train --live` as a viewer sees it: an independent WebSocket client takes Foxglove's place.

use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use predicates::prelude::*;
use predicates::str::contains;
use serde_json::{Value, json};
use tempfile::TempDir;
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket};

mod common;

use common::prf;

const CONFIG: &str = "\
seed = 5
[env]
name = \"breakout\"
limit_steps = 40
[reward]
source = \"perceptual\"
descriptor = \"direct\"
goal = \"black.png\"
[train]
steps = 1000000
environments = 4
batch_size = 8
replay_steps = 400
learning_starts = 100
steps_per_update = 16
threads = 1
[evaluation]
every_episodes = 8
episodes = 3
";

fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    image::GrayImage::new(84, 84).save(folder.path().join("black.png")).expect("the folder is ours");
    fs::write(folder.path().join("c.toml"), CONFIG).expect("the folder is ours");
    folder
}

/// A run that ends with the test.
struct Run(Child);

impl Drop for Run {
    fn drop(&mut self) {
        self.0.kill().expect("it is ours");
        self.0.wait().expect("it is ours");
    }
}

/// Starts a run and gives the address it says it serves on.
fn start(folder: &Path) -> (Run, String) {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("prf"));
    command.current_dir(folder).args(["train", "c.toml", "--out", "run", "--live", "127.0.0.1:0"]);
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("prf starts");
    let stderr = BufReader::new(child.stderr.take().expect("it is piped"));
    let mut lines = stderr.lines().map(|line| line.expect("words"));
    let line = lines.find(|line| line.contains("ws://")).expect("the address is told");
    // What is told later has to go somewhere.
    std::thread::spawn(move || lines.for_each(drop));
    (Run(child), line[line.find("ws://").expect("it was found")..].to_owned())
}

fn connect(url: &str) -> WebSocket<TcpStream> {
    let mut request = url.into_client_request().expect("an address");
    request.headers_mut().insert("Sec-WebSocket-Protocol", "foxglove.sdk.v1".parse().expect("a header"));
    let stream = TcpStream::connect(url.trim_start_matches("ws://")).expect("it listens");
    stream.set_read_timeout(Some(Duration::from_secs(120))).expect("a timeout can be set");
    let (socket, response) = tungstenite::client(request, stream).expect("it shakes hands");
    assert_eq!(response.headers()["Sec-WebSocket-Protocol"], "foxglove.sdk.v1");
    socket
}

/// The topics that are advertised, with their numbers and schemas.
fn advertised(socket: &mut WebSocket<TcpStream>) -> BTreeMap<String, (u64, String)> {
    let mut found = BTreeMap::new();
    while found.len() < 11 {
        let Message::Text(text) = socket.read().expect("a message") else { continue };
        let message: Value = serde_json::from_str(&text).expect("JSON");
        if message["op"] == "advertise" {
            for channel in message["channels"].as_array().expect("a list") {
                let name = |key: &str| channel[key].as_str().expect("a name").to_owned();
                found.insert(name("topic"), (channel["id"].as_u64().expect("a number"), name("schemaName")));
            }
        }
    }
    found
}

/// The time and the payload of the next message of a subscription.
fn next(socket: &mut WebSocket<TcpStream>, subscription: u32) -> (u64, Vec<u8>) {
    loop {
        let Message::Binary(bytes) = socket.read().expect("a message") else { continue };
        // Opcode 1: message data; then the subscription, the time and the payload.
        let is_it = bytes[0] == 1 && bytes[1..5] == subscription.to_le_bytes();
        if is_it {
            return (u64::from_le_bytes(bytes[5..13].try_into().expect("8 bytes")), bytes[13..].to_vec());
        }
    }
}

#[test]
fn a_viewer_is_served_what_is_recorded() {
    let folder = folder();
    let (_run, url) = start(folder.path());
    let mut socket = connect(&url);
    let topics = advertised(&mut socket);
    assert_eq!(topics["/evaluation/mirror"].1, "foxglove.RawImage");
    assert_eq!(topics["/evaluation/match"].1, "foxglove.ImageAnnotations");
    let subscriptions: Vec<_> = [(1, "/goal"), (2, "/evaluation/step"), (3, "/evaluation/mirror")]
        .map(|(id, topic)| json!({ "id": id, "channelId": topics[topic].0 }))
        .into();
    let subscribe = json!({ "op": "subscribe", "subscriptions": subscriptions });
    socket.send(Message::text(subscribe.to_string())).expect("it listens");

    let black = vec![0; 84 * 84];
    let (_, goal) = next(&mut socket, 1);
    assert!(goal.windows(black.len()).any(|part| part == black), "a latecomer is shown the goal");
    let mut steps = (0..).map(|_| {
        let (time, numbers) = next(&mut socket, 2);
        let numbers: Value = serde_json::from_slice(&numbers).expect("JSON");
        (time, numbers)
    });
    let (first, numbers) = steps.find(|(_, numbers)| numbers["step"] == 1).expect("an episode begins");
    assert!(numbers["reward"].as_f64().is_some_and(|reward| reward > 0.0 && reward < 1.0), "{numbers}");
    let (second, numbers) = steps.next().expect("it goes on");
    assert_eq!((&numbers["step"], second - first), (&json!(2), 1_000_000_000 / 15));
}

/// One who subscribes and never reads, and one who goes without a word.
#[test]
fn viewers_who_are_slow_or_gone_do_not_hold_the_run_up() {
    let folder = folder();
    let (_run, url) = start(folder.path());
    let mut viewers = [connect(&url), connect(&url)];
    for viewer in &mut viewers {
        let topics = advertised(viewer);
        let subscriptions: Vec<_> =
            (1..).zip(topics.values()).map(|(id, (channel, _))| json!({ "id": id, "channelId": channel })).collect();
        let subscribe = json!({ "op": "subscribe", "subscriptions": subscriptions });
        viewer.send(Message::text(subscribe.to_string())).expect("it listens");
        // Not every topic has messages; of steps there are always some.
        let steps = topics.keys().position(|topic| topic == "/evaluation/step").expect("it is served");
        next(viewer, steps as u32 + 1);
    }
    let [_slow, gone] = viewers;
    drop(gone);
    let evaluations = || {
        let text = fs::read_to_string(folder.path().join("run/metrics.jsonl")).unwrap_or_default();
        text.lines().filter(|line| line.contains("\"evaluation\"")).count()
    };
    let before = evaluations();
    let deadline = std::time::Instant::now() + Duration::from_secs(240);
    while evaluations() < before + 5 {
        assert!(std::time::Instant::now() < deadline, "the run stands still");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn an_address_that_cannot_be_had_is_told_before_anything_begins() {
    let folder = folder();
    let taken = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = taken.local_addr().expect("an address").to_string();
    let live = |address: &str| prf(folder.path()).args(["train", "c.toml", "--out", "run", "--live", address]).assert();
    live(&address).code(1).stderr(contains(format!("cannot serve on {address}")).and(contains("hint:")));
    live("192.0.2.1:8765").code(1).stderr(contains("an address of this machine"));
    for nonsense in ["c.toml", "localhost", "127.0.0.1:99999"] {
        live(nonsense).code(2).stderr(contains("as in 127.0.0.1:8765"));
    }
    assert!(!folder.path().join("run").exists(), "a run was begun");
}
