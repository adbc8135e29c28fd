//! `prf train --live`: the messages of `run.mcap`, served to Foxglove while the run goes on.

use std::io::ErrorKind;
use std::net::SocketAddr;
use std::sync::Arc;

use foxglove::websocket::{ChannelView, Client, ServerListener};
use foxglove::{ChannelBuilder, Context, FoxgloveError, PartialMetadata, RawChannel, WebSocketServerHandle};
use prf_core::Goal;
use prf_dqn::record::{Clock, Event, Message, Recorder, Topic, goal_message, messages};

use crate::error::{CliError, Result};

/// Messages that wait for a viewer who is slow; then the oldest are dropped, and the run goes on as if nobody looked.
const BACKLOG: usize = 4096;

/// Serves recorded episodes over Foxglove's WebSocket protocol. Its clock begins at 0 with the server.
pub(crate) struct LiveServer {
    server: WebSocketServerHandle,
    /// Knows which channels there are, for viewers to come.
    _context: Arc<Context>,
    channels: Vec<(Topic, Arc<RawChannel>)>,
    clock: Clock,
}

impl LiveServer {
    /// Listens on `address`.
    pub(crate) fn start(address: SocketAddr, goal: Option<&Goal>) -> Result<LiveServer> {
        let context = Context::new();
        let channel = |topic: Topic| {
            let channel = ChannelBuilder::new(topic.name()).context(&context).schema(topic.schema());
            Ok((topic, channel.message_encoding(topic.encoding()).build_raw()?))
        };
        let channels = Topic::ALL.into_iter().map(channel).collect::<std::result::Result<Vec<_>, FoxgloveError>>()?;
        let mut server = context.websocket_server().name("prf").message_backlog_size(BACKLOG);
        if let Some(goal) = goal {
            let channel = channels.iter().find(|(topic, _)| *topic == Topic::Goal).map(|(_, channel)| channel.clone());
            let goal = goal_message(goal.picture.view());
            server = server.listener(Arc::new(Latecomers { channel, goal }));
        }
        // A host of version 6 stands in brackets.
        let bound = address.to_string();
        let host = bound.rsplit_once(':').map_or("", |(host, _)| host);
        let server = server.bind(host, address.port()).start_blocking().map_err(|error| refused(address, error))?;
        Ok(LiveServer { server, _context: context, channels, clock: Clock::default() })
    }

    /// Where Foxglove finds it.
    pub(crate) fn url(&self, address: SocketAddr) -> String {
        format!("ws://{}", SocketAddr::new(address.ip(), self.server.port()))
    }

    /// Says goodbye to whoever looks.
    pub(crate) fn stop(self) {
        self.server.stop().wait_blocking();
    }
}

fn refused(address: SocketAddr, error: FoxgloveError) -> anyhow::Error {
    let FoxgloveError::Bind(source) = error else { return error.into() };
    let hint = match source.kind() {
        ErrorKind::AddrInUse => {
            "something else listens there, perhaps another run: name another port, as in --live 127.0.0.1:8766"
        }
        ErrorKind::PermissionDenied => "name a port from 1024 up, as in --live 127.0.0.1:8765",
        _ => "name an address of this machine, as in --live 127.0.0.1:8765",
    };
    CliError::failed(format!("cannot serve on {address}: {source}")).hint(hint).into()
}

/// Shows the goal to each viewer who comes.
struct Latecomers {
    channel: Option<Arc<RawChannel>>,
    goal: Message,
}

impl ServerListener for Latecomers {
    fn on_subscribe(&self, client: Client, view: ChannelView<'_>) {
        if let Some(channel) = self.channel.as_ref().filter(|channel| channel.id() == view.id()) {
            channel.log_with_meta_to_sink(&self.goal.data, at(&self.goal), client.sink_id());
        }
    }
}

fn at(message: &Message) -> PartialMetadata {
    PartialMetadata::with_log_time(message.time_ns)
}

impl Recorder for LiveServer {
    fn record(&mut self, event: &Event<'_>) -> prf_dqn::Result<()> {
        for message in messages(event, &mut self.clock) {
            if let Some((_, channel)) = self.channels.iter().find(|(topic, _)| *topic == message.topic) {
                channel.log_with_meta(&message.data, at(&message));
            }
        }
        Ok(())
    }
}
