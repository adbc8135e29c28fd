//! Numbers that can be drawn in proportion to their size.

/// A binary tree whose leaves are weights and whose other nodes are the sums of their two children. A node is always computed
/// from its children, never by adding differences, so that equal weights give equal sums, whatever there was before.
#[derive(Debug, Clone)]
pub(super) struct SumTree {
    /// Node 1 is the root, the children of `i` are `2i` and `2i + 1`, and the leaves are the last half.
    nodes: Vec<f64>,
}

impl SumTree {
    /// A tree of these weights, each 0 or more; at least one.
    pub(super) fn new(weights: &[f32]) -> Self {
        let mut nodes = vec![0.0; weights.len()];
        nodes.extend(weights.iter().map(|&weight| f64::from(weight)));
        for node in (1..weights.len()).rev() {
            nodes[node] = nodes[2 * node] + nodes[2 * node + 1];
        }
        Self { nodes }
    }

    pub(super) fn len(&self) -> usize {
        self.nodes.len() / 2
    }

    /// The sum of all weights.
    pub(super) fn total(&self) -> f64 {
        self.nodes[1]
    }

    pub(super) fn get(&self, leaf: usize) -> f32 {
        self.nodes[self.len() + leaf] as f32
    }

    pub(super) fn set(&mut self, leaf: usize, weight: f32) {
        let mut node = self.len() + leaf;
        self.nodes[node] = weight.into();
        while node > 1 {
            node /= 2;
            self.nodes[node] = self.nodes[2 * node] + self.nodes[2 * node + 1];
        }
    }

    /// The leaf in whose part of the total `mark`, from 0 to the total, lies. A leaf of weight 0 has no part; some other has
    /// to weigh more.
    pub(super) fn find(&self, mut mark: f64) -> usize {
        let mut node = 1;
        while node < self.len() {
            let (left, right) = (self.nodes[2 * node], self.nodes[2 * node + 1]);
            // What rounding leaves over at the right end must not lead to where there is nothing.
            node = if mark < left || right == 0.0 {
                2 * node
            } else {
                mark -= left;
                2 * node + 1
            };
        }
        node - self.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn marks_fall_to_leaves_in_proportion_to_their_weights() {
        let weights = [3.0, 0.0, 1.0, 4.0, 2.0];
        let tree = SumTree::new(&weights);
        assert_eq!((tree.len(), tree.total()), (5, 10.0));
        let mut hits = [0.0; 5];
        (0..100).for_each(|tenth| hits[tree.find(f64::from(tenth) / 10.0 + 0.05)] += 0.1);
        for (hit, weight) in hits.into_iter().zip(weights) {
            assert!((hit - weight).abs() < 1e-4, "{hits:?}");
        }
    }

    #[test]
    fn a_single_leaf_is_always_found() {
        let mut tree = SumTree::new(&[0.0]);
        tree.set(0, 2.5);
        assert_eq!((tree.total(), tree.find(0.0), tree.find(2.5), tree.get(0)), (2.5, 0, 0, 2.5));
    }

    proptest! {
        #[test]
        fn what_was_changed_equals_what_is_built_anew(
            weights in prop::collection::vec(0.0f32..1e3, 1..40),
            changes in prop::collection::vec((0usize..40, 0.0f32..1e-3), 0..100),
        ) {
            let mut weights = weights;
            let mut tree = SumTree::new(&weights);
            for (leaf, weight) in changes {
                let leaf = leaf % weights.len();
                weights[leaf] = weight;
                tree.set(leaf, weight);
            }
            prop_assert_eq!(tree.nodes, SumTree::new(&weights).nodes);
        }

        #[test]
        fn a_leaf_without_weight_is_never_found(
            weights in prop::collection::vec(prop_oneof![Just(0.0f32), 1e-20f32..1e20], 1..40),
            part in 0.0f64..=1.0,
        ) {
            let tree = SumTree::new(&weights);
            prop_assume!(tree.total() > 0.0);
            prop_assert!(tree.get(tree.find(part * tree.total())) > 0.0);
        }
    }
}
