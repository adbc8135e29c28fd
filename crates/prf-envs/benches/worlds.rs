//! Steps a second: a world with its picture, and a whole task with its reward.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use prf_core::{Frame, Goal};
use prf_envs::{EnvConfig, Environment, RewardConfig, StateConfig, Task, TaskConfig, registry};

fn world(criterion: &mut Criterion) {
    registry::names().for_each(|name| measure(criterion, name));
}

fn measure(criterion: &mut Criterion, name: &str) {
    let mut world = registry::make(&EnvConfig::new(name)).expect("the registry has it");
    let mut frame = Frame::new(world.spec().width, world.spec().height);
    let mut group = criterion.benchmark_group(name);
    group.throughput(Throughput::Elements(1));
    let mut seed = 0;
    world.reset(seed);
    group.bench_function("step and draw", |bencher| {
        bencher.iter(|| {
            step(world.as_mut(), &mut seed);
            world.draw_into(&mut frame);
        });
    });
    group.bench_function("oracle", |bencher| {
        bencher.iter(|| world.oracle_action());
    });
    group.finish();
}

/// Plays without a plan, which keeps Breakout's wall, and so the drawing, as large as it gets.
fn step(world: &mut dyn Environment, seed: &mut u64) {
    let action = *seed as usize % world.spec().actions.len();
    let step = world.step(action).expect("the action exists");
    if step.status.is_over() {
        *seed += 1;
        world.reset(*seed);
    }
}

fn task(criterion: &mut Criterion) {
    let goal = Goal::from(Frame::new(84, 84));
    let tasks = [
        ("perceptual", RewardConfig::perceptual("black.png"), Some(&goal)),
        ("variable", RewardConfig::variable(), None),
    ];
    let mut group = criterion.benchmark_group("breakout task");
    group.throughput(Throughput::Elements(1));
    for (name, reward, goal) in tasks {
        let config = TaskConfig { env: EnvConfig::new("breakout"), reward, state: StateConfig::default() };
        let mut task = Task::new(&config, goal).expect("the config is valid");
        let mut seed = 0;
        task.reset(seed);
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                if task.step(0).expect("the action exists").status.is_over() {
                    seed += 1;
                    task.reset(seed);
                }
            });
        });
    }
    group.finish();
}

criterion_group!(benches, world, task);
criterion_main!(benches);
