//! The report as one HTML page that needs nothing else: pictures are data URIs, and nothing is fetched or run.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use prf_core::{Picture, io};
use prf_envs::{RewardSource, Status};

use super::claims::{Claim, Verdict};
use super::episode::{Episode, RankedFrame};
use super::{Chapter, Played, Report};
use crate::commands::learning::duration;
use crate::error::Result;
use crate::plot::curve::Shape;
use crate::runs::diagram::Picture as CurvePicture;
use crate::runs::name_of;
use crate::runs::standing::{Standing, State};

const STYLE: &str = include_str!("style.css");
/// Whatever a page holds, no browser may fetch anything for it.
const POLICY: &str = "default-src 'none'; img-src data:; style-src 'unsafe-inline'";

/// The page.
///
/// # Errors
///
/// A diagram or a moving picture can't be made.
pub(crate) fn html(report: &Report<'_>) -> Result<String> {
    let runs: usize = report.chapters.iter().map(|chapter| chapter.group.runs.len()).sum();
    let title = format!(
        "{}: a report of {}",
        report.world,
        if runs == 1 { "1 run".to_owned() } else { format!("{runs} runs") }
    );
    let chapters = report.chapters.iter().map(chapter).collect::<Result<Vec<_>>>()?;
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="color-scheme" content="light dark";
                title { (title) }
                link rel="icon" href="data:,";
                style { (PreEscaped(STYLE)) }
            }
            body {
                header {
                    p.kind { "Perceptual reward functions" }
                    h1 { (title) }
                    p { "The world: " (report.summary) "." }
                    @for chapter in &report.chapters { p.headline { (chapter.headline) } }
                }
                main {
                    (curves(report)?)
                    @for chapter in chapters { (chapter) }
                }
                footer {
                    p {
                        "± is a standard deviation, over seeds where there are several. Scores are those of the greedy evaluations during \
                         training. Made by prf " (env!("CARGO_PKG_VERSION")) " with "
                        code { "prf report" } "."
                    }
                }
            }
        }
    };
    Ok(page.into_string())
}

fn curves(report: &Report<'_>) -> Result<Markup> {
    if report.curves.is_empty() {
        return Ok(html! { section { h2 { "Learning curves" } p { "No run has been evaluated yet." } } });
    }
    let picture = CurvePicture {
        question: report.question,
        world: report.world,
        curves: &report.curves,
        players: report.players,
    };
    Ok(html! {
        section {
            h2 { "Learning curves" }
            figure {
                div.wide { (PreEscaped(picture.svg(Shape::Untitled)?)) }
                div.narrow { (PreEscaped(picture.svg(Shape::Narrow)?)) }
                figcaption { "Greedy score over steps of training: " (picture.subtitle()) "." }
            }
        }
    })
}

fn chapter(chapter: &Chapter<'_>) -> Result<Markup> {
    Ok(html! {
        section.chapter {
            h2 { (chapter.group.name) }
            h3 { "Claims" }
            (claims(&chapter.claims))
            h3 { "What was run" }
            (task(chapter))
            h3 { "Runs" }
            (table(&chapter.standings))
            (played(&chapter.played)?)
            details {
                summary { "The config of seed " (chapter.group.runs[0].config.seed) }
                pre { code { (chapter.config) } }
            }
        }
    })
}

fn claims(claims: &[Claim]) -> Markup {
    html! {
        ul.claims {
            @for claim in claims {
                @let (class, mark, verdict) = match claim.verdict {
                    Verdict::Holds => ("holds", "✓", "holds"),
                    Verdict::Fails => ("fails", "✗", "does not hold"),
                    Verdict::Open => ("open", "?", "cannot be told"),
                };
                li class=(class) {
                    span.mark aria-hidden="true" { (mark) }
                    div {
                        p { (claim.words) " " strong { (verdict) "." } }
                        p.figures { (claim.figures) }
                    }
                }
            }
        }
    }
}

fn task(chapter: &Chapter<'_>) -> Markup {
    let config = &chapter.group.runs[0].config;
    let seeds: Vec<String> = chapter.group.runs.iter().map(|run| run.config.seed.to_string()).collect();
    let length = match (config.train.steps, config.train.episodes) {
        (Some(steps), _) => format!("{steps} steps"),
        (None, Some(episodes)) => format!("{episodes} episodes"),
        (None, None) => "no length".to_owned(),
    };
    let reward = match (config.reward.source, config.reward.descriptor) {
        (RewardSource::Perceptual, Some(descriptor)) => {
            format!(
                "how much the screen looks like the goal: F = exp(−D), {} descriptor",
                format!("{descriptor:?}").to_lowercase()
            )
        }
        _ => "what the world itself gives".to_owned(),
    };
    let facts = [
        ("World", format!("{}, up to {} steps an episode", config.env.name, config.env.limit_steps)),
        ("Reward", reward),
        ("Length", format!("{length}, in {} environments at once", config.train.environments)),
        ("Seeds", seeds.join(", ")),
        ("Versions", versions(chapter)),
        ("Machine", machines(chapter)),
    ];
    html! {
        div.task {
            dl { @for (name, fact) in facts { dt { (name) } dd { (fact) } } }
            @if let Some(goal) = &chapter.goal {
                figure.goal {
                    (image(&png_uri(&io::png(goal.picture.view())), "the goal's picture", "world"))
                    figcaption { "The goal" }
                }
            }
        }
    }
}

/// What the manifests say, each thing once.
fn distinct(values: impl Iterator<Item = String>) -> String {
    let mut known: Vec<String> = Vec::new();
    for value in values {
        if !known.contains(&value) {
            known.push(value);
        }
    }
    if known.is_empty() { "not recorded".to_owned() } else { known.join("; ") }
}

fn versions(chapter: &Chapter<'_>) -> String {
    distinct(chapter.manifests().map(|manifest| {
        let revision = manifest.git_revision.as_ref().map_or(String::new(), |revision| format!(" ({revision})"));
        format!("prf {}{revision}, libtorch {}", manifest.prf_version, manifest.libtorch_version)
    }))
}

fn machines(chapter: &Chapter<'_>) -> String {
    distinct(chapter.manifests().map(|manifest| {
        let threads =
            if manifest.threads == 1 { "1 thread".to_owned() } else { format!("{} threads", manifest.threads) };
        let machine = manifest.machine.as_ref().map_or(String::new(), |machine| format!(" of {machine}"));
        format!("{}, {threads}{machine}", manifest.device)
    }))
}

fn table(standings: &[Standing]) -> Markup {
    let score = |score: Option<f64>| score.map_or("–".to_owned(), |score| format!("{score:.2}"));
    html! {
        div.scroll tabindex="0" role="region" aria-label="Runs" {
            table {
                thead {
                    tr { th { "Run" } th.number { "Seed" } th { "State" } th.number { "Steps" } th.number { "Last" } th.number { "Best" } th.number { "Time" } }
                }
                tbody {
                    @for standing in standings {
                        tr {
                            td { (name_of(&standing.path)) }
                            td.number { (standing.config.as_ref().map_or("–".to_owned(), |config| config.seed.to_string())) }
                            td { (state(&standing.state)) }
                            td.number { (standing.steps) }
                            td.number { (score(standing.last_score)) }
                            td.number { (score(standing.best_score)) }
                            td.number { (standing.manifest.as_ref().map_or("–".to_owned(), |m| duration(m.time.total_s()))) }
                        }
                    }
                }
            }
        }
    }
}

fn state(state: &State) -> String {
    match state {
        State::Finished => "finished".to_owned(),
        State::Running => "running".to_owned(),
        State::Interrupted(_) => "interrupted".to_owned(),
        State::NeverSaved => "never saved".to_owned(),
        State::Damaged(problem) => format!("damaged: {problem}"),
    }
}

fn played(played: &Played) -> Result<Markup> {
    let (episode, agent) = match played {
        Played::NoModel => return Ok(html! { h3 { "The agent playing" } p { "No run has saved an agent yet." } }),
        Played::Broken(problem) => {
            return Ok(html! { h3 { "The agent playing" } p.problem { "It can't be shown: " (problem) "." } });
        }
        Played::Episode { episode, agent } => (episode, agent),
    };
    let ending = match episode.status {
        Status::Running => "it was stopped there",
        Status::Terminated => "the world ended it",
        Status::Truncated => "the time was up",
    };
    let alt = format!("the agent of {agent}, playing");
    Ok(html! {
        h3 { "The agent playing" }
        figure.playing {
            picture {
                // A moving picture can't be stopped without a script.
                source media="(prefers-reduced-motion: reduce)" srcset=(png_uri(&io::png(episode.first().view())));
                (image(&uri("image/gif", &episode.gif()?), &alt, "world"))
            }
            figcaption {
                "The agent of " (agent) ", without exploration, in an episode that it was neither trained nor evaluated on: a score of "
                (episode.score) " and a reward of " (format!("{:.2}", episode.reward)) " in " (episode.steps) " steps; " (ending) "."
                @if episode.left_out() > 0 { " The last " (episode.left_out()) " steps are not shown." }
            }
        }
        (ranking(episode))
    })
}

fn ranking(episode: &Episode) -> Markup {
    html! {
        @if let (Some(best), Some(worst)) = (episode.best.first(), episode.worst.first()) {
            h3 { "What the reward ranks best and worst" }
            p { "Of all frames of this episode. If the best ones look no closer to the goal than the worst, the reward is no good." }
            (ranked("The highest rewards", &episode.best))
            (ranked("The lowest rewards", &episode.worst))
            h4 { "What was compared in the best frame" }
            (compared(best))
            h4 { "What was compared in the worst frame" }
            (compared(worst))
        } @else if episode.best.is_empty() && episode.worst.is_empty() {
            p { "The reward is the world's own and sees no pictures, so it ranks no frames." }
        }
    }
}

fn ranked(title: &str, frames: &[RankedFrame]) -> Markup {
    html! {
        h4 { (title) }
        div.frames {
            @for frame in frames {
                figure {
                    (image(&png_uri(&io::png(frame.frame.view())), &format!("the screen after step {}", frame.step), "world"))
                    figcaption { strong { "F = " (short(frame.score.reward)) } br; "step " (frame.step) ", score " (frame.points) }
                }
            }
        }
    }
}

fn compared(frame: &RankedFrame) -> Markup {
    let comparison = &frame.comparison;
    let agent = frame.matched.map_or("in green, what of it was compared".to_owned(), |matched| {
        format!("the window (orange) matches by {matched:.3}; in green, what of it was compared")
    });
    let panels: [(&Picture, &str, String); 3] = [
        (&comparison.goal, "Goal", "in green, what of it was compared".to_owned()),
        (&comparison.agent, "Agent", agent),
        (&comparison.differences, "What differs", "each cell's share of D², the brightest the largest".to_owned()),
    ];
    html! {
        p { "After step " (frame.step) ": distance D = " (short(frame.score.distance)) ", reward F = exp(−D) = " (short(frame.score.reward)) "." }
        div.frames {
            @for (picture, name, words) in panels {
                figure {
                    (image(&png_uri(&io::picture_png(picture)), name, "world"))
                    figcaption { strong { (name) } br; (words) }
                }
            }
        }
    }
}

fn image(uri: &str, alt: &str, class: &str) -> Markup {
    html! { img class=(class) src=(uri) alt=(alt); }
}

fn png_uri(png: &[u8]) -> String {
    uri("image/png", png)
}

fn uri(kind: &str, bytes: &[u8]) -> String {
    format!("data:{kind};base64,{}", STANDARD.encode(bytes))
}

/// Four digits, also of a very small number.
fn short(value: f32) -> String {
    if value != 0.0 && value < 1e-3 { format!("{value:.2e}") } else { format!("{value:.4}") }
}
