//! A cache that drops its oldest values when their total weight exceeds a limit.

use std::collections::VecDeque;

/// Values by key, as many as together weigh no more than a limit.
pub(super) struct Latest<K, V> {
    /// The oldest first, with their weights.
    kept: VecDeque<(K, V, usize)>,
    weight: usize,
    most: usize,
}

impl<K: PartialEq, V> Latest<K, V> {
    /// Cache with a limit of `most`.
    pub(super) fn new(most: usize) -> Self {
        Self {
            kept: VecDeque::new(),
            weight: 0,
            most,
        }
    }

    /// Keeps a value in place of its key's former one, and drops the oldest while the total exceeds the limit.
    pub(super) fn keep(&mut self, key: K, value: V, weight: usize) {
        self.take(&key);
        self.weight += weight;
        self.kept.push_back((key, value, weight));
        while self.weight > self.most
            && let Some((_, _, oldest)) = self.kept.pop_front()
        {
            self.weight -= oldest;
        }
    }

    /// The value of a key.
    pub(super) fn get(&self, key: &K) -> Option<&V> {
        let mut newest_first = self.kept.iter().rev();
        newest_first
            .find(|(known, ..)| known == key)
            .map(|(_, value, _)| value)
    }

    /// Takes the value of a key out of the cache.
    pub(super) fn take(&mut self, key: &K) -> Option<V> {
        let place = self.kept.iter().rposition(|(known, ..)| known == key)?;
        let (_, value, weight) = self.kept.remove(place)?;
        self.weight -= weight;
        Some(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_go_first_and_a_key_has_one_value() {
        let mut latest = Latest::new(10);
        for (key, weight) in [(1, 4), (2, 4), (1, 5)] {
            latest.keep(key, 10 * key + weight, weight);
        }
        assert_eq!((latest.get(&1), latest.get(&2)), (Some(&15), Some(&24)));
        latest.keep(3, 0, 2);
        assert_eq!((latest.get(&2), latest.get(&1)), (None, Some(&15)));
        assert_eq!((latest.take(&1), latest.take(&1)), (Some(15), None));
        // A value above the limit is not kept.
        latest.keep(4, 0, 11);
        assert_eq!((latest.get(&3), latest.get(&4)), (None, None));
    }
}
