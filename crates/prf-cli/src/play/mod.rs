//! Playing a world: by a person in a terminal, watched, or unseen.
//!
//! [`session`] is the world with its episodes and feeds the [`recorder`]. Everything about a terminal is apart from it:
//! [`keys`] and [`hand`] make actions of keys, [`game`] decides when a step is due, [`layout`], [`panel`], [`blocks`] and
//! [`screen`] show a world as text, and [`live`] is the loop that joins them.

mod blocks;
mod events;
mod game;
mod hand;
mod keys;
mod layout;
pub(crate) mod live;
pub(crate) mod outputs;
mod panel;
pub(crate) mod recorder;
mod screen;
pub(crate) mod session;
pub(crate) mod unseen;
