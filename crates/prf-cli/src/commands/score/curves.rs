//! The rewards of one call as a diagram.

use std::path::Path;

use prf_core::DescriptorKind;
use prf_core::io::FrameInfo;

use crate::error::Result;
use crate::plot::axis::Axis;
use crate::plot::curve::{Band, Curve, Diagram, Joined, Shape};

/// The rewards of every source, in order. Single pictures make one source together.
#[derive(Default)]
pub(super) struct Curves {
    sources: Vec<Source>,
    /// Which of them holds the single pictures.
    pictures: Option<usize>,
    /// Which of them is read now, if one is that isn't a single picture.
    open: Option<usize>,
    /// Pictures that could not be scored before the first one that could.
    lost_before: usize,
}

struct Source {
    name: String,
    /// Frames that could not be scored have nothing.
    frames: Vec<Option<Scored>>,
}

#[derive(Clone, Copy)]
struct Scored {
    time_s: Option<f64>,
    reward: f32,
}

impl Curves {
    /// What follows are the frames of this folder, animation or video.
    pub(super) fn begin(&mut self, path: &Path) {
        self.open = Some(self.sources.len());
        self.sources.push(Source { name: path.to_string_lossy().into_owned(), frames: Vec::new() });
    }

    /// What follows are single pictures again.
    pub(super) fn end(&mut self) {
        self.open = None;
    }

    pub(super) fn take(&mut self, info: &FrameInfo, reward: f32) {
        let at = self.open.unwrap_or_else(|| self.pictures(&info.path));
        self.sources[at].frames.push(Some(Scored { time_s: info.time_s, reward }));
    }

    /// The source of single pictures, made with the first of them and named after it while it is the only one.
    fn pictures(&mut self, path: &Path) -> usize {
        if let Some(at) = self.pictures {
            let pictures = self.sources[at].scored().count() + 1;
            self.sources[at].name = format!("{pictures} pictures");
            return at;
        }
        self.begin(path);
        self.pictures = self.open.take();
        let at = self.sources.len() - 1;
        self.sources[at].frames.resize(self.lost_before, None);
        at
    }

    /// A frame, or a whole source, could not be scored.
    pub(super) fn lose(&mut self) {
        match self.open.or(self.pictures) {
            Some(at) => self.sources[at].frames.push(None),
            None => self.lost_before += 1,
        }
    }

    /// The diagram, of at least one reward; `lost` frames or sources could not be scored.
    pub(super) fn svg(&self, goal: &Path, kind: DescriptorKind, lost: usize) -> Result<String> {
        let sources: Vec<&Source> = self.sources.iter().filter(|source| source.scored().next().is_some()).collect();
        let by_time =
            sources.iter().any(|source| source.scored().count() > 1) && sources.iter().all(|source| source.has_times());
        let curves: Vec<Curve> = sources.iter().map(|source| source.curve(by_time)).collect();
        let points = || curves.iter().flat_map(|curve| curve.points.iter().flatten());
        let last = points().map(|point| point.0).fold(0.0, f64::max);
        let rewards = || points().map(|point| point.1);
        let descriptor = match kind {
            DescriptorKind::Direct => "direct",
            DescriptorKind::Window => "window",
            DescriptorKind::Motion => "motion",
        };
        let lost = if lost == 0 { String::new() } else { format!(", {lost} could not be scored") };
        let diagram = Diagram {
            title: format!("Reward for the goal {}", goal.display()),
            subtitle: format!("{descriptor} descriptor, {}{lost}", super::frames(points().count())),
            x: if by_time { Axis::seconds(last) } else { Axis::frames(last) },
            y: Axis::rewards(rewards().fold(1.0, f64::min), rewards().fold(0.0, f64::max)),
            curves: &curves,
            levels: &[],
            joined: Joined::Line,
        };
        diagram.svg(Shape::Titled)
    }
}

impl Source {
    fn scored(&self) -> impl Iterator<Item = Scored> {
        self.frames.iter().flatten().copied()
    }

    /// Whether its frames can be placed in time, as a single frame always can.
    fn has_times(&self) -> bool {
        let last = self.scored().last().and_then(|frame| frame.time_s);
        self.scored().count() == 1 || (self.scored().all(|frame| frame.time_s.is_some()) && last > Some(0.0))
    }

    fn curve(&self, by_time: bool) -> Curve {
        let point = |(place, frame): (usize, &Option<Scored>)| {
            frame.map(|Scored { time_s, reward }| {
                let x = if by_time { time_s.unwrap_or(0.0) } else { place as f64 };
                (x, f64::from(reward))
            })
        };
        let points = self.frames.iter().enumerate().map(point).collect();
        Curve { name: self.name.clone(), points, band: Band::new() }
    }
}
