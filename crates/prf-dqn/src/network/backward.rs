//! The backward pass, written out, so that two workers can share it.

use std::sync::Mutex;
use std::sync::mpsc::{Receiver, Sender, channel};

use rayon::Scope;
use tch::{Kind, Tensor};

use super::columns;
use super::layers::{Dense, Layers, Trace, channels_first, channels_last, mean};
use super::shape::Convolution;
use crate::compute::Pair;
use crate::error::Result;

impl Layers {
    /// Finds the gradients of all parameters from that of a pass's values, and hands those of each layer's weights and biases to
    /// the one of `take` that stands in the layer's place, from the input to the output.
    ///
    /// By then nothing computes with the layer's parameters any more. One worker goes back from layer to layer; what no other
    /// layer waits for is done by whoever is free.
    pub(crate) fn backward<T>(&self, trace: Trace, values: &Tensor, pair: &Pair, take: Vec<T>) -> Result<()>
    where
        T: FnOnce([Tensor; 2]) -> Result<()> + Send,
    {
        let layers = self.share();
        let values = values.shallow_clone();
        let outcome = Mutex::new(Ok(()));
        let note = &|result: Result<()>| {
            let mut outcome = outcome.lock().expect("nothing panics while it is held");
            // Of several errors the first one counts.
            if outcome.is_ok() {
                *outcome = result;
            }
        };
        pair.scope(move |scope| note(layers.go_back(trace, &values, take, scope, note)));
        outcome.into_inner().expect("nothing panicked while it was held")
    }

    fn go_back<'scope, T>(
        self,
        trace: Trace,
        values: &Tensor,
        take: Vec<T>,
        scope: &Scope<'scope>,
        note: &'scope (impl Fn(Result<()>) + Sync),
    ) -> Result<()>
    where
        T: FnOnce([Tensor; 2]) -> Result<()> + Send + 'scope,
    {
        let Trace { mut pictures, hidden, .. } = trace;
        let mut take_convolutions = take;
        let mut take_streams = take_convolutions.split_off(self.convolutions.len()).into_iter();
        let mut out = pictures.pop().expect("what came out of the last convolution");
        let features = out.f_view([hidden[0].size()[0], -1])?;

        // Nothing is spawned before this is over: whoever waits for a part of a layer's step takes up other tasks, and a task waits
        // for what only this worker can send.
        let mut of_hidden = Vec::new();
        for ((gradient, hidden), [_, output]) in self.of_streams(values)?.into_iter().zip(&hidden).zip(&self.streams) {
            let gradient = gradient.f_to_kind(output.weight.kind())?;
            let before = hidden.f_threshold_backward(&output.back(&gradient)?, 0)?;
            let (take_hidden, take_output) = (next(&mut take_streams), next(&mut take_streams));
            take_output(gradients(&gradient, hidden)?)?;
            of_hidden.push((before, take_hidden));
        }
        let spawn = |(of_hidden, take): (Tensor, T)| {
            let used = Task::new(&of_hidden, &features, None).spawn(take, scope, note);
            (of_hidden, used)
        };
        let of_hidden: Vec<(Tensor, Used)> = of_hidden.into_iter().map(spawn).collect();
        let mut gradient: Option<Tensor> = None;
        for ((of_hidden, used), [hidden, _]) in of_hidden.into_iter().zip(&self.streams) {
            let of_features = hidden.back(&of_hidden)?;
            used.send();
            gradient = Some(match gradient {
                None => of_features,
                Some(mut sum) => sum.f_add_(&of_features)?,
            });
        }
        let mut gradient = gradient.expect("there is a stream");

        let layers = self.convolutions.iter().zip(take_convolutions).enumerate().rev();
        for (index, ((layer, dense), take)) in layers {
            let of_out = out.f_threshold_backward(&gradient.f_view_as(&out)?, 0)?;
            out = pictures.pop().expect("what went into the convolution");
            let used = Task::new(&of_out, &out, Some(*layer)).spawn(take, scope, note);
            if index > 0 {
                gradient = dense.back_to_pictures(&of_out, layer)?;
            }
            used.send();
        }
        Ok(())
    }

    /// The gradient of what comes out of each stream, from that of the values.
    fn of_streams(&self, values: &Tensor) -> Result<Vec<Tensor>> {
        if self.streams.len() == 1 {
            return Ok(vec![values.shallow_clone()]);
        }
        let value = values.f_sum_dim_intlist([1i64].as_slice(), true, Kind::Float)?;
        Ok(vec![value, values.f_sub(&mean(values)?)?])
    }
}

fn next<T>(take: &mut impl Iterator<Item = T>) -> T {
    take.next().expect("there is one for each layer")
}

/// A layer's gradients, to be found at any time.
struct Task {
    /// The gradient of what came out.
    outputs: Tensor,
    /// What went in.
    inputs: Tensor,
    /// What it goes over, if it is a convolution.
    convolution: Option<Convolution>,
}

/// To be sent once a layer's parameters aren't computed with any more.
struct Used(Sender<()>);

impl Used {
    fn send(self) {
        // A task that has failed says so itself.
        let _ = self.0.send(());
    }
}

impl Task {
    fn new(outputs: &Tensor, inputs: &Tensor, convolution: Option<Convolution>) -> Self {
        Self { outputs: outputs.shallow_clone(), inputs: inputs.shallow_clone(), convolution }
    }

    fn spawn<'scope, T>(self, take: T, scope: &Scope<'scope>, note: &'scope (impl Fn(Result<()>) + Sync)) -> Used
    where
        T: FnOnce([Tensor; 2]) -> Result<()> + Send + 'scope,
    {
        let (used, when_used) = channel();
        scope.spawn(move |_| note(self.run(take, &when_used)));
        Used(used)
    }

    fn run(self, take: impl FnOnce([Tensor; 2]) -> Result<()>, when_used: &Receiver<()>) -> Result<()> {
        let inputs = match &self.convolution {
            None => self.inputs,
            Some(layer) => columns::of_pictures(&self.inputs, layer)?,
        };
        let found = gradients(&self.outputs, &inputs)?;
        match when_used.recv() {
            Ok(()) => take(found),
            // The way back has failed, which it says itself.
            Err(_) => Ok(()),
        }
    }
}

/// The gradients of a layer's weights and biases, from that of what came out of it and from what it multiplied.
fn gradients(outputs: &Tensor, inputs: &Tensor) -> Result<[Tensor; 2]> {
    let bias = outputs.f_sum_dim_intlist([0i64].as_slice(), false, outputs.kind())?;
    Ok([outputs.f_tr()?.f_matmul(inputs)?, bias])
}

impl Dense {
    /// The gradient of what went in, from that of what came out.
    fn back(&self, outputs: &Tensor) -> Result<Tensor> {
        Ok(outputs.f_matmul(&self.weight)?)
    }

    /// The gradient of the pictures that went into the convolution `layer`.
    fn back_to_pictures(&self, outputs: &Tensor, layer: &Convolution) -> Result<Tensor> {
        let kernels = channels_first(&self.weight, [layer.kernel; 2], layer.inputs)?;
        let outputs = channels_first(outputs, layer.to, layer.outputs)?;
        // Rows and columns that no kernel reached.
        let rest = layer.from.map(|side| ((side - layer.kernel) % layer.stride) as i64);
        let (none, stride) = (None::<Tensor>, [layer.stride as i64; 2]);
        channels_last(&outputs.f_conv_transpose2d(&kernels, none, stride, [0; 2], rest, 1, [1; 2])?, layer.inputs)
    }
}
