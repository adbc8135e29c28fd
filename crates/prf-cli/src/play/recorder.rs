//! What is kept of an episode.

use prf_core::{Frame, MotionParams, MotionTemplate, io};
use prf_envs::Environment;

use crate::error::Result;
use crate::gif::GreyGif;

/// What is to be kept.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Plan {
    pub(crate) gif: Option<GifPlan>,
    pub(crate) frames: bool,
    pub(crate) motion: Option<MotionParams>,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct GifPlan {
    /// How many times the world's own size.
    pub(crate) scale: usize,
    pub(crate) frames_per_second: u32,
}

/// Keeps the last episode in which a step was taken: beginning another one loses nothing before its first step.
pub(crate) struct Recorder {
    plan: Plan,
    /// The start of an episode that has no step yet.
    start: Option<Shot>,
    tape: Option<Tape>,
}

impl Recorder {
    pub(crate) fn new(plan: Plan) -> Recorder {
        Recorder { plan, start: None, tape: None }
    }

    /// Takes note that an episode begins as `world` is.
    pub(crate) fn begin(&mut self, world: &dyn Environment) {
        self.start = Some(Shot::of(world, self.plan));
    }

    /// Takes note that a step led to what `world` is.
    ///
    /// # Errors
    ///
    /// If there is no memory left for it, or the GIF would be too large.
    pub(crate) fn step(&mut self, world: &dyn Environment) -> Result<()> {
        if let Some(start) = self.start.take() {
            let mut tape = Tape::new(&start, self.plan)?;
            tape.add(&start)?;
            self.tape = Some(tape);
        }
        match &mut self.tape {
            Some(tape) => tape.add(&Shot::of(world, self.plan)),
            None => Ok(()),
        }
    }

    /// What was recorded; nothing if no step was ever taken.
    ///
    /// # Errors
    ///
    /// If the GIF cannot be completed.
    pub(crate) fn finish(self) -> Result<Option<Recording>> {
        self.tape.map(Tape::finish).transpose()
    }
}

/// An episode as it will be in files.
#[derive(Debug)]
pub(crate) struct Recording {
    /// How many frames there were, the start included.
    pub(crate) frames: usize,
    pub(crate) gif: Option<Vec<u8>>,
    /// A PNG for each frame; none if they were not asked for.
    pub(crate) pngs: Vec<Vec<u8>>,
    /// The motion template.
    pub(crate) motion: Option<Frame>,
}

/// A moment of the world.
struct Shot {
    own: Frame,
    large: Option<Frame>,
}

impl Shot {
    fn of(world: &dyn Environment, plan: Plan) -> Shot {
        let spec = world.spec();
        let draw = |scale: usize| {
            let mut frame = Frame::new(spec.width * scale, spec.height * scale);
            world.draw_into(&mut frame);
            frame
        };
        Shot { own: draw(1), large: plan.gif.map(|gif| draw(gif.scale)) }
    }
}

struct Tape {
    frames: usize,
    gif: Option<GreyGif>,
    pngs: Option<Vec<Vec<u8>>>,
    motion: Option<MotionTemplate>,
}

impl Tape {
    fn new(start: &Shot, plan: Plan) -> Result<Tape> {
        let gif = match (plan.gif, &start.large) {
            (Some(gif), Some(large)) => Some(GreyGif::new(large.width(), large.height(), gif.frames_per_second)?),
            _ => None,
        };
        let motion = plan.motion.map(MotionTemplate::new).transpose()?;
        Ok(Tape { frames: 0, gif, pngs: plan.frames.then(Vec::new), motion })
    }

    fn add(&mut self, shot: &Shot) -> Result<()> {
        self.frames += 1;
        if let (Some(gif), Some(large)) = (&mut self.gif, &shot.large) {
            gif.add(large.view())?;
        }
        if let Some(pngs) = &mut self.pngs {
            pngs.push(io::png(shot.own.view()));
        }
        if let Some(motion) = &mut self.motion {
            motion.observe(shot.own.view())?;
        }
        Ok(())
    }

    fn finish(self) -> Result<Recording> {
        let motion = self.motion.map(|template| {
            let mut picture = Frame::new(1, 1);
            template.history_into(&mut picture);
            picture
        });
        let gif = self.gif.map(GreyGif::finish).transpose()?;
        Ok(Recording { frames: self.frames, gif, pngs: self.pngs.unwrap_or_default(), motion })
    }
}

#[cfg(test)]
mod tests {
    use prf_envs::{EnvConfig, registry};

    use super::*;

    fn breakout(seed: u64) -> Box<dyn Environment> {
        let mut world = registry::make(&EnvConfig::new("breakout")).expect("there is Breakout");
        world.reset(seed);
        world
    }

    fn png_of(world: &dyn Environment) -> Vec<u8> {
        io::png(Shot::of(world, Plan::default()).own.view())
    }

    fn frames_only() -> Recorder {
        Recorder::new(Plan { frames: true, ..Plan::default() })
    }

    fn step(world: &mut dyn Environment, recorder: &mut Recorder) {
        world.step(0).expect("it goes on");
        recorder.step(world).expect("there is memory");
    }

    #[test]
    fn an_episode_that_is_broken_off_is_kept_up_to_there() {
        let mut world = breakout(1);
        let mut recorder = frames_only();
        let mut expected = vec![png_of(world.as_ref())];
        recorder.begin(world.as_ref());
        for _ in 0..3 {
            step(world.as_mut(), &mut recorder);
            expected.push(png_of(world.as_ref()));
        }
        let recording = recorder.finish().expect("it is complete").expect("there were steps");
        assert_eq!((recording.frames, recording.pngs), (4, expected));
        assert!(recording.gif.is_none() && recording.motion.is_none());
    }

    #[test]
    fn without_a_step_there_is_nothing() {
        assert!(frames_only().finish().expect("that is no error").is_none());
        let mut recorder = frames_only();
        recorder.begin(breakout(1).as_ref());
        assert!(recorder.finish().expect("that is no error").is_none());
    }

    #[test]
    fn the_last_episode_counts_from_its_first_step_on() {
        let mut recorder = frames_only();
        let mut first = breakout(1);
        recorder.begin(first.as_ref());
        step(first.as_mut(), &mut recorder);
        step(first.as_mut(), &mut recorder);

        let mut second = breakout(2);
        let start = png_of(second.as_ref());
        recorder.begin(second.as_ref());
        assert_eq!(recorder.tape.as_ref().map(|tape| tape.frames), Some(3), "the first is still there");
        step(second.as_mut(), &mut recorder);
        let recording = recorder.finish().expect("it is complete").expect("there was a step");
        assert_eq!((recording.frames, &recording.pngs[0]), (2, &start));
    }
}
