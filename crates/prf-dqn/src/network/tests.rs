//! The network beside libtorch's own layers and its autograd.

use std::sync::mpsc::channel;

use prf_envs::rng::{stream, unit_f32};
use tch::Reduction;

use super::*;
use crate::compute::Precision;

/// The network as libtorch's own layers have it, whose gradients its autograd finds.
pub(crate) fn by_autograd(network: &QNetwork, bytes: &[u8]) -> (Tensor, Vec<Tensor>) {
    let [height, width] = network.architecture.input;
    let flat = network.to_vec().expect("values");
    let mut rest = flat.as_slice();
    let leaves: Vec<Tensor> = network
        .architecture
        .parameters()
        .into_iter()
        .map(|(_, shape)| {
            let (head, tail) = rest.split_at(shape.iter().product::<i64>() as usize);
            rest = tail;
            Tensor::from_slice(head).view(&shape[..]).set_requires_grad(true)
        })
        .collect();
    let mut x = Tensor::from_slice(bytes).view([-1, 1, height, width]).to_kind(Kind::Float) / 255.0;
    for (layer, stride) in [4, 2, 1].into_iter().enumerate() {
        x = x.conv2d(&leaves[2 * layer], Some(&leaves[2 * layer + 1]), [stride; 2], [0, 0], [1, 1], 1).relu();
    }
    let x = x.flatten(1, -1);
    let streams: Vec<Tensor> = leaves[6..]
        .chunks_exact(4)
        .map(|layer| x.linear(&layer[0], Some(&layer[1])).relu().linear(&layer[2], Some(&layer[3])))
        .collect();
    let values = match &streams[..] {
        [value, advantage] => value + advantage - advantage.mean_dim([1i64].as_slice(), true, Kind::Float),
        _ => streams[0].shallow_clone(),
    };
    (values, leaves)
}

/// Tensors as one vector.
pub(crate) fn flat(tensors: &[Tensor]) -> Vec<f32> {
    let flat: Vec<Tensor> = tensors.iter().map(|tensor| tensor.flatten(0, -1)).collect();
    tensor_to_vec(&Tensor::cat(&flat, 0)).expect("values")
}

/// How far `found` is from `expected`, beside the size of this.
pub(crate) fn distance(found: &[f32], expected: &[f32]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let squares = |values: &mut dyn Iterator<Item = f32>| values.map(|value| f64::from(value).powi(2)).sum::<f64>();
    let difference = squares(&mut found.iter().zip(expected).map(|(found, expected)| found - expected));
    (difference / squares(&mut expected.iter().copied())).sqrt()
}

/// Sides of which the first has blocks that the second convolution doesn't reach; with neither is there a whole number of blocks.
const SIDES: [i64; 2] = [50, 54];

fn network(input: [i64; 2], dueling: bool, compute: &Compute) -> QNetwork {
    let architecture = Architecture { input, actions: 3, dueling };
    let network = QNetwork::new(architecture, compute, &mut stream(3, "network", 0)).expect("network");
    // Biases that are not all 0.
    let mut values = network.to_vec().expect("values");
    let mut rng = stream(4, "biases", 0);
    values.iter_mut().filter(|value| **value == 0.0).for_each(|value| *value = 0.1 * unit_f32(&mut rng) - 0.05);
    QNetwork::from_flat(network.architecture, &values, compute).expect("network")
}

fn pictures(count: usize) -> Vec<u8> {
    let mut rng = stream(5, "pictures", 0);
    (0..count * 50 * 54).map(|_| (unit_f32(&mut rng) * 255.0) as u8).collect()
}

fn traced(network: &QNetwork, bytes: &[u8]) -> Trace {
    let layers = network.layers();
    layers.forward(&layers.pictures(bytes).expect("pictures")).expect("forward")
}

/// The gradients of all parameters. When those of a layer are handed over, `done` is told the layer's number.
fn gradients(
    network: &QNetwork,
    trace: Trace,
    values: &Tensor,
    done: impl Fn(usize) -> Result<()> + Sync,
) -> Result<Vec<Tensor>> {
    let (send, receive) = channel();
    let done = &done;
    let take = (0..network.architecture.lengths().len()).map(|index| {
        let send = send.clone();
        move |found| {
            send.send((index, found)).expect("it is received");
            done(index)
        }
    });
    network.layers().backward(trace, values, network.compute.pair(), take.collect())?;
    drop(send);
    let mut found: Vec<(usize, [Tensor; 2])> = receive.into_iter().collect();
    found.sort_by_key(|(index, _)| *index);
    Ok(found.into_iter().flat_map(|(_, found)| found).collect())
}

#[test]
fn values_and_gradients_are_those_of_libtorch_and_its_autograd() {
    let [height, width] = SIDES;
    for (input, dueling, precision, count, tolerance) in [
        ([height, width], false, Precision::F32, 5, 1e-5),
        ([width, height], true, Precision::F32, 5, 1e-5),
        ([height, width], true, Precision::F32, 1, 1e-5),
        ([height, width], true, Precision::Bf16, 5, 0.1),
    ] {
        let network = network(input, dueling, &Compute::on_cpu(precision, 0));
        let bytes = pictures(count);
        let (expected, leaves) = by_autograd(&network, &bytes);
        let trace = traced(&network, &bytes);
        let values = flat(&[expected.shallow_clone()]);
        let close = |name: &str, found: &[f32], expected: &[f32]| {
            let distance = distance(found, expected);
            assert!(distance < tolerance, "{name} of {input:?} {dueling} {precision:?}: {distance}");
        };
        close("values", &flat(&[trace.values.shallow_clone()]), &values);
        close("values in parts", &network.q_values(&bytes, count).expect("values"), &values);

        let wanted = Tensor::from_slice(&[0.3f32, -2.0, 1.0]).expand([count as i64, 3], false);
        let gradient = (&trace.values - &wanted) * 2.0;
        let expected = Tensor::run_backward(&[expected.mse_loss(&wanted, Reduction::Sum)], &leaves, false, false);
        let found = gradients(&network, trace, &gradient, |_| Ok(())).expect("backward");
        assert_eq!(found.len(), expected.len());
        let found = network.architecture.named(&flat(&found));
        let mut rest = found.as_slice();
        for ((name, _), expected) in network.architecture.parameters().into_iter().zip(&expected) {
            let (found, others) = rest.split_at(expected.numel());
            close(&name, found, &flat(&[expected.shallow_clone()]));
            rest = others;
        }
    }
}

#[test]
fn nothing_computes_with_a_layer_whose_gradients_are_handed_over() {
    for threads in [1, 2] {
        for _ in 0..10 {
            let network = network(SIDES, true, &Compute::on_cpu(Precision::F32, threads));
            let trace = traced(&network, &pictures(32));
            let gradient = trace.values.shallow_clone();
            let layers = network.parameters.flat.split_with_sizes(network.architecture.lengths(), 0);
            let layers = std::sync::Mutex::new(layers);
            let spoil = |layer: usize| {
                let _ = layers.lock().expect("no panic")[layer].fill_(f64::NAN);
                Ok(())
            };
            let found = gradients(&network, trace, &gradient, spoil);
            let found = flat(&found.expect("backward"));
            assert!(found.iter().all(|gradient| gradient.is_finite()));
            assert!(network.to_vec().expect("values").iter().all(|value| value.is_nan()));
        }
    }
}

#[test]
fn an_error_in_a_step_comes_back() {
    for threads in [1, 2] {
        let network = network(SIDES, true, &Compute::on_cpu(Precision::F32, threads));
        for failing in 0..network.architecture.lengths().len() {
            let trace = traced(&network, &pictures(4));
            let gradient = trace.values.shallow_clone();
            let fail =
                |layer| if layer == failing { Err(Error::Torch(tch::TchError::Kind("it".to_owned()))) } else { Ok(()) };
            let error = gradients(&network, trace, &gradient, fail).expect_err("one step failed").to_string();
            assert!(error.contains("it"), "{error}");
        }
        // Of fewer actions than there are: the way back fails at once.
        let trace = traced(&network, &pictures(4));
        assert!(gradients(&network, trace, &Tensor::zeros([4, 2], (Kind::Float, Device::Cpu)), |_| Ok(())).is_err());
    }
}

#[test]
fn the_values_of_a_dueling_network_are_v_plus_a_minus_its_mean() {
    let architecture = Architecture { input: [36, 36], actions: 2, dueling: true };
    let shapes = architecture.parameters();
    let mut values: Vec<f32> =
        shapes.iter().flat_map(|(_, shape)| vec![0.0; shape.iter().product::<i64>() as usize]).collect();
    // Every hidden unit is 1, whatever the picture: the value is 512 · 0.01 + 0.5, the advantages are 512 · 0.02 + 1 and 3.
    let mut rest = values.as_mut_slice();
    for (name, shape) in &shapes {
        let (layer, tail) = rest.split_at_mut(shape.iter().product::<i64>() as usize);
        match name.as_str() {
            "value.hidden.bias" | "advantage.hidden.bias" => layer.fill(1.0),
            "value.output.weight" => layer.fill(0.01),
            "value.output.bias" => layer.fill(0.5),
            "advantage.output.weight" => layer[..512].fill(0.02),
            "advantage.output.bias" => layer.copy_from_slice(&[1.0, 3.0]),
            _ => {}
        }
        rest = tail;
    }
    let network = QNetwork::from_flat(architecture, &values, &Compute::plain()).expect("network");
    let found = network.q_values(&[7; 36 * 36], 1).expect("values");
    let (value, advantages) = (5.62, [11.24, 3.0]);
    for (found, advantage) in found.iter().zip(advantages) {
        let expected = value + advantage - (11.24 + 3.0) / 2.0;
        assert!((found - expected).abs() < 1e-4, "{found} should be {expected}");
    }
}
