//! Draws a world some steps into an oracle's episode, for its page in `docs/worlds`:
//! `cargo run -p prf-envs --example draw_world -- breakout 400 4 docs/worlds/breakout.png`

use std::error::Error;

use prf_core::{Frame, io};
use prf_envs::{EnvConfig, registry};

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<_> = std::env::args().skip(1).collect();
    let [name, steps, scale, path] = args.as_slice() else {
        return Err("expected: WORLD STEPS SCALE FILE.png".into());
    };
    let steps: u32 = steps.parse()?;
    let scale: usize = scale.parse()?;
    let mut world = registry::make(&EnvConfig { limit_steps: steps + 1, ..EnvConfig::new(name) })?;
    world.reset(0);
    for _ in 0..steps {
        world.step(world.oracle_action())?;
    }
    let spec = world.spec();
    let mut frame = Frame::new(spec.width * scale, spec.height * scale);
    world.draw_into(&mut frame);
    Ok(io::write_frame(frame.view(), path)?)
}
