//! `prf worlds`: what there is to learn and to play.

use prf_envs::players::{Oracle, Random, mean_score};
use prf_envs::{EnvConfig, registry};
use serde::Serialize;

use crate::ExitStatus;
use crate::error::Result;
use crate::printer::{Format, Printer};

/// Episodes that a player's mean score is taken over: those of the seeds 0 to 99.
const EPISODES: u64 = 100;

#[derive(Debug, Serialize)]
struct World {
    name: &'static str,
    summary: &'static str,
    actions: &'static [&'static str],
    width: usize,
    height: usize,
    limit_steps: u32,
    real_time: bool,
    oracle_score: f64,
    random_score: f64,
    page: &'static str,
}

pub(crate) fn run(printer: &mut Printer) -> Result<ExitStatus> {
    for (index, name) in registry::names().enumerate() {
        let world = describe(name)?;
        match printer.format() {
            Format::Json => printer.record(&world)?,
            Format::Text => print(&world, index == 0, printer)?,
        }
    }
    Ok(ExitStatus::Done)
}

fn describe(name: &'static str) -> Result<World> {
    let mut world = registry::make(&EnvConfig::new(name))?;
    let spec = *world.spec();
    Ok(World {
        name,
        summary: registry::summary(name).unwrap_or_default(),
        actions: spec.actions,
        width: spec.width,
        height: spec.height,
        limit_steps: spec.limit_steps,
        real_time: registry::controls(name).is_some_and(|controls| controls.pace.is_real_time()),
        oracle_score: mean_score(world.as_mut(), &mut Oracle, 0..EPISODES)?,
        random_score: mean_score(world.as_mut(), &mut Random::new(), 0..EPISODES)?,
        page: registry::page(name).unwrap_or_default(),
    })
}

fn print(world: &World, is_first: bool, printer: &mut Printer) -> Result<()> {
    let World { name, summary, actions, width, height, limit_steps, oracle_score, random_score, page, .. } = world;
    if !is_first {
        printer.line("")?;
    }
    printer.line(format!("{name}: {summary}"))?;
    printer.line(format!("  actions  {}: {}", actions.len(), actions.join(", ")))?;
    printer.line(format!("  frame    {width}x{height} px"))?;
    printer.line(format!("  limit    {limit_steps} steps"))?;
    printer.line(format!("  oracle   {oracle_score:.2}, the mean score of {EPISODES} episodes"))?;
    printer.line(format!("  random   {random_score:.2}"))?;
    printer.line(format!("  page     {page}"))
}
