//! STUB, replaced on merge.
#![allow(missing_docs, clippy::allow_attributes)]
use crate::{Error, Frame, FrameView, Rect};
use serde::{Deserialize, Serialize};
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MatchMethod {
    #[default]
    CcorrNormed,
    CcoeffNormed,
}
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Match {
    pub rect: Rect,
    pub score: f32,
}
#[derive(Clone, Debug)]
pub struct TemplateMatcher {
    t: Frame,
    mask: Option<Frame>,
    method: MatchMethod,
}
impl TemplateMatcher {
    pub fn new(template: &Frame, mask: Option<&Frame>, method: MatchMethod) -> Result<TemplateMatcher, Error> {
        Ok(TemplateMatcher { t: template.clone(), mask: mask.cloned(), method })
    }
    pub fn prepare(&mut self, shape: [usize; 2]) -> Result<(), Error> {
        if shape[0] < self.t.height() || shape[1] < self.t.width() {
            return Err(Error::invalid(
                "goal",
                &format!("{}x{} px", self.t.width(), self.t.height()),
                format!("at most the frame's {}x{} px", shape[1], shape[0]),
            ));
        }
        Ok(())
    }
    pub fn best(&mut self, f: FrameView<'_>) -> Result<Match, Error> {
        self.prepare([f.height(), f.width()])?;
        let (w, h) = (self.t.width(), self.t.height());
        let mut best = Match { rect: Rect { x: 0, y: 0, width: w, height: h }, score: f32::MIN };
        for y in 0..=f.height() - h {
            for x in 0..=f.width() - w {
                let (mut ab, mut a2, mut b2, mut a, mut b, mut n) = (0f64, 0f64, 0f64, 0f64, 0f64, 0f64);
                for j in 0..h {
                    for i in 0..w {
                        if self.mask.as_ref().is_some_and(|m| m.view().row(j)[i] == 0) {
                            continue;
                        }
                        let (p, q) = (f64::from(f.row(y + j)[x + i]), f64::from(self.t.view().row(j)[i]));
                        ab += p * q;
                        a2 += p * p;
                        b2 += q * q;
                        a += p;
                        b += q;
                        n += 1.0;
                    }
                }
                if self.method == MatchMethod::CcoeffNormed {
                    ab -= a * b / n;
                    a2 -= a * a / n;
                    b2 -= b * b / n;
                }
                let s = if a2 > 0.0 && b2 > 0.0 { (ab / (a2 * b2).sqrt()) as f32 } else { 0.0 };
                if s > best.score {
                    best.score = s;
                    best.rect.x = x;
                    best.rect.y = y;
                }
            }
        }
        Ok(best)
    }
}
