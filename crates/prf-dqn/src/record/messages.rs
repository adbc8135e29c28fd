//! Events as messages on topics, which `run.mcap` holds and `--live` serves: Foxglove's own schemas for pictures, JSON for numbers.

use std::borrow::Cow;

use foxglove::messages::{Color, ImageAnnotations, Point2, PointsAnnotation, RawImage, Timestamp, points_annotation};
use foxglove::{Encode, Schema};
use prf_core::{FrameView, Match, Rect};
use serde::Serialize;

use super::{EpisodeKind, Event, StepRecord};

/// Time from one recorded step to the next: 15 are played back in a second.
pub const STEP_NS: u64 = 1_000_000_000 / 15;

/// The one clock of a recording: it begins at 0 and goes on by [`STEP_NS`] with each recorded step, whenever that was, so that
/// episodes play back at an even speed and the same run gives the same recording.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Clock {
    /// Steps recorded so far.
    pub steps: u64,
}

impl Clock {
    /// The time of the newest recorded step, in nanoseconds.
    pub fn now_ns(self) -> u64 {
        self.steps.saturating_sub(1) * STEP_NS
    }
}

/// What a message is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Topic {
    /// The goal's picture, once.
    Goal,
    /// The world's picture after each step.
    Mirror(EpisodeKind),
    /// Where a window goal was found in it.
    Match(EpisodeKind),
    /// The agent's template `T_A`: what was compared.
    Template(EpisodeKind),
    /// The numbers of each step.
    Step(EpisodeKind),
    /// Episodes summed up: [`TrainRecord`](super::TrainRecord) and [`EvaluationRecord`](super::EvaluationRecord) without what
    /// depends on the wall clock.
    Summary(EpisodeKind),
}

/// A message, ready to be written or sent.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// Where it belongs.
    pub topic: Topic,
    /// When, by the recording's [`Clock`], in nanoseconds.
    pub time_ns: u64,
    /// What, in the topic's encoding.
    pub data: Vec<u8>,
}

impl Topic {
    /// Every topic.
    pub const ALL: [Self; 11] = {
        use EpisodeKind::{Evaluation, Training};
        [
            Self::Goal,
            Self::Mirror(Evaluation),
            Self::Match(Evaluation),
            Self::Template(Evaluation),
            Self::Step(Evaluation),
            Self::Summary(Evaluation),
            Self::Mirror(Training),
            Self::Match(Training),
            Self::Template(Training),
            Self::Step(Training),
            Self::Summary(Training),
        ]
    };

    /// Its name, as in `/evaluation/mirror`.
    pub fn name(self) -> &'static str {
        use EpisodeKind::{Evaluation, Training};
        match self {
            Self::Goal => "/goal",
            Self::Mirror(Evaluation) => "/evaluation/mirror",
            Self::Match(Evaluation) => "/evaluation/match",
            Self::Template(Evaluation) => "/evaluation/template",
            Self::Step(Evaluation) => "/evaluation/step",
            Self::Summary(Evaluation) => "/evaluation/summary",
            Self::Mirror(Training) => "/training/mirror",
            Self::Match(Training) => "/training/match",
            Self::Template(Training) => "/training/template",
            Self::Step(Training) => "/training/step",
            Self::Summary(Training) => "/training/summary",
        }
    }

    /// What its messages look like.
    pub fn schema(self) -> Schema {
        match self {
            Self::Goal | Self::Mirror(_) | Self::Template(_) => RawImage::get_schema().expect("it is a known message"),
            Self::Match(_) => ImageAnnotations::get_schema().expect("it is a known message"),
            Self::Step(_) => json_schema("prf.Step", include_str!("messages/step.json")),
            Self::Summary(EpisodeKind::Training) => json_schema("prf.Training", include_str!("messages/training.json")),
            Self::Summary(EpisodeKind::Evaluation) => {
                json_schema("prf.Evaluation", include_str!("messages/evaluation.json"))
            }
        }
    }

    /// How its messages are encoded: `protobuf` or `json`.
    pub fn encoding(self) -> &'static str {
        match self {
            Self::Goal | Self::Mirror(_) | Self::Template(_) | Self::Match(_) => "protobuf",
            Self::Step(_) | Self::Summary(_) => "json",
        }
    }
}

fn json_schema(name: &str, text: &'static str) -> Schema {
    Schema::new(name, "jsonschema", Cow::Borrowed(text.as_bytes()))
}

/// The goal's picture at the clock's beginning.
pub fn goal_message(goal: FrameView<'_>) -> Message {
    image(Topic::Goal, 0, goal)
}

/// What an event has to say, in order; the clock goes on with each step.
pub fn messages(event: &Event<'_>, clock: &mut Clock) -> Vec<Message> {
    match event {
        Event::Step(step) => {
            clock.steps += 1;
            step_messages(step, clock.now_ns())
        }
        Event::Train(record) => vec![json(Topic::Summary(EpisodeKind::Training), clock.now_ns(), &timeless(record))],
        Event::Evaluation(record) => {
            vec![json(Topic::Summary(EpisodeKind::Evaluation), clock.now_ns(), &timeless(record))]
        }
        Event::Progress(_) | Event::Checkpoint(_) => Vec::new(),
    }
}

fn step_messages(step: &StepRecord<'_>, time_ns: u64) -> Vec<Message> {
    let matched = step.explanation.and_then(|explanation| explanation.matched);
    let mut messages = vec![image(Topic::Mirror(step.kind), time_ns, step.mirror)];
    if let Some(matched) = matched {
        messages.push(outline(Topic::Match(step.kind), time_ns, matched.rect));
    }
    if let Some(explanation) = step.explanation {
        messages.push(image(Topic::Template(step.kind), time_ns, explanation.agent_template().view()));
    }
    messages.push(json(Topic::Step(step.kind), time_ns, &Numbers::of(step, matched)));
    messages
}

/// The numbers of a step, as `step.json` describes them.
#[derive(Serialize)]
struct Numbers {
    kind: EpisodeKind,
    trained_steps: u64,
    episode: u64,
    step: u32,
    action: usize,
    action_name: &'static str,
    reward: f32,
    #[serde(skip_serializing_if = "Option::is_none")]
    distance: Option<f32>,
    score: f32,
    epsilon: f32,
    #[serde(skip_serializing_if = "Option::is_none")]
    r#match: Option<MatchNumbers>,
}

#[derive(Serialize)]
struct MatchNumbers {
    x: usize,
    y: usize,
    width: usize,
    height: usize,
    score: f32,
}

impl Numbers {
    fn of(step: &StepRecord<'_>, matched: Option<Match>) -> Self {
        let &StepRecord {
            kind, trained_steps, episode, step: place, action, action_name, reward, score, epsilon, ..
        } = step;
        Self {
            kind,
            trained_steps,
            episode,
            step: place,
            action,
            action_name,
            reward,
            distance: step.explanation.map(|explanation| explanation.score.distance),
            score,
            epsilon,
            r#match: matched.map(|Match { rect: Rect { x, y, width, height }, score, .. }| MatchNumbers {
                x,
                y,
                width,
                height,
                score,
            }),
        }
    }
}

/// A record as `metrics.jsonl` has it, less what another run of the same bits would tell otherwise.
fn timeless(record: &impl Serialize) -> serde_json::Value {
    let mut value = serde_json::to_value(record).expect("records hold only numbers and strings");
    if let Some(fields) = value.as_object_mut() {
        fields.retain(|key, value| key != "time_s" && key != "steps_per_s" && !value.is_null());
    }
    value
}

fn json(topic: Topic, time_ns: u64, value: &impl Serialize) -> Message {
    Message { topic, time_ns, data: serde_json::to_vec(value).expect("records hold only numbers and strings") }
}

fn image(topic: Topic, time_ns: u64, frame: FrameView<'_>) -> Message {
    let image = RawImage {
        timestamp: Some(timestamp(time_ns)),
        frame_id: topic.name().trim_start_matches('/').to_owned(),
        width: frame.width() as u32,
        height: frame.height() as u32,
        encoding: "mono8".to_owned(),
        step: frame.width() as u32,
        data: frame.as_slice().to_vec().into(),
    };
    encoded(topic, time_ns, &image)
}

/// A rectangle around the pixels of `rect`.
fn outline(topic: Topic, time_ns: u64, rect: Rect) -> Message {
    let [left, top, right, bottom] =
        [rect.x, rect.y, rect.x + rect.width, rect.y + rect.height].map(|side| side as f64);
    let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
    let box_ = PointsAnnotation {
        timestamp: Some(timestamp(time_ns)),
        r#type: points_annotation::Type::LineLoop as i32,
        points: corners.into_iter().map(|(x, y)| Point2 { x, y }).collect(),
        outline_color: Some(Color { r: 1.0, g: 0.55, b: 0.0, a: 1.0 }),
        thickness: 1.0,
        ..Default::default()
    };
    encoded(topic, time_ns, &ImageAnnotations { points: vec![box_], ..Default::default() })
}

fn encoded(topic: Topic, time_ns: u64, message: &impl Encode) -> Message {
    let mut data = Vec::with_capacity(message.encoded_len().unwrap_or_default());
    message.encode(&mut data).expect("a vector has room");
    Message { topic, time_ns, data }
}

fn timestamp(time_ns: u64) -> Timestamp {
    Timestamp::new((time_ns / 1_000_000_000) as u32, (time_ns % 1_000_000_000) as u32)
}
