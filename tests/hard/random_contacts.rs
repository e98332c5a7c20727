//! Random shocks on rough surfaces, through their contacts: what a contact may not do, and the energy balance.

use opshock_solver::air_bearing::gap_forces::AsperityContact;
use opshock_solver::head::{
    ContactWork, HeadRun, HeadWorkspace, SliderContact, SliderEpisode, Verdict,
};
use opshock_tests::seeded::{OnPanic, Seeded, seeds};
use rayon::prelude::*;

use crate::random_heads::{RandomShock, TOLERANCE, random_head};

/// What an episode may give back beyond what it took, as a share of it: the error of the works' integration over steps.
const OF_WORK: f64 = 0.05;

/// Less work than this is that of a film in flight, J.
const LITTLE_J: f64 = 1e-12;

/// Imbalance of energy at the end, of the largest energy, at [`FINE`]. Steps of the preset's tolerance are too long for the suspension's
/// fast modes and for hard impacts.
const IMBALANCE: f64 = 0.02;

/// Tolerance at which they are resolved.
const FINE: f64 = 1e-4;

/// One scene in so many runs again at [`FINE`].
const AGAIN: u64 = 25;

/// Rough or smooth, hard or soft asperities, few or many.
fn random_contact(seeded: &mut Seeded) -> AsperityContact {
    AsperityContact {
        roughness_m: seeded.log_between(0.1e-9, 2e-9),
        asperities_per_m2: seeded.log_between(1e13, 1e15),
        tip_radius_m: seeded.log_between(0.2e-6, 5e-6),
        modulus_pa: seeded.log_between(2e10, 3e11),
        yield_pressure_pa: seeded.log_between(0.5e9, 50e9),
        friction: seeded.between(0.0, 1.0),
    }
}

/// A run through its contacts, and the largest pressure of its asperities; `None` where the head does not fly.
fn run(seed: u64, tolerance: f64) -> Option<(HeadRun, f64)> {
    let mut seeded = Seeded::new(0xc0 ^ (seed << 8));
    let rough = random_contact(&mut seeded);
    let (model, _) = random_head(&mut seeded, rough, tolerance)?;
    let shock = RandomShock::of(&mut seeded, 200.0);
    let mut workspace = HeadWorkspace::new(&model);
    let (load, disk) = (shock.load(), shock.disk());
    let run = model.run(&disk, &load, shock.window_s, false, true, &mut workspace);
    Some((run, rough.yield_pressure_pa))
}

/// What holds at any instant of any run.
fn judge(run: &HeadRun) {
    assert!(run.cost.min_pressure_pa > 0.0, "{:?}", run.cost);
    let columns = run.columns.as_ref().expect("recorded");
    for column in [
        &columns.slider_z_m,
        &columns.slider_pitch_rad,
        &columns.slider_roll_rad,
        &columns.bearing_force_n,
        &columns.dimple_force_n,
        &columns.asperity_force_n,
    ] {
        assert!(column.iter().all(|value| value.is_finite()));
    }
    let mut forces = columns.asperity_force_n.iter();
    assert!(forces.all(|&force_n| force_n >= 0.0));
}

fn work(episode: &SliderEpisode) -> ContactWork {
    episode.work.expect("the run goes on")
}

/// What holds of the contacts of a run that reached the end of its window.
fn judge_contacts(contact: &SliderContact, most_pa: f64) {
    let sum = |of: fn(&SliderEpisode) -> f64| contact.episodes.iter().map(of).sum::<f64>();
    for episode in &contact.episodes {
        assert!(episode.on_s < episode.off_s, "{episode:?}");
        let [mean_pa, peak_pa] = [episode.mean_pressure_pa, episode.peak_pressure_pa];
        assert!(
            0.0 < mean_pa && mean_pa <= (1.0 + 1e-12) * peak_pa && peak_pa <= most_pa,
            "{episode:?}"
        );
        assert!(
            episode.impulse_n_s >= 0.0 && episode.friction_j >= 0.0,
            "{episode:?}"
        );
        let ContactWork {
            loading_j,
            unloading_j,
        } = work(episode);
        let most_j = (1.0 + OF_WORK) * loading_j + LITTLE_J;
        assert!(unloading_j <= most_j, "{episode:?}");
    }
    let total_j = sum(|one| work(one).loading_j);
    let yielded_j = contact.yielded_j;
    assert!(yielded_j.is_finite());
    if !contact.goes_on {
        let kept_j = total_j - sum(|one| work(one).unloading_j);
        assert!(
            (kept_j - yielded_j).abs() <= OF_WORK * total_j + LITTLE_J,
            "taken less given {kept_j:e} J, kept {yielded_j:e} J of {total_j:e}"
        );
    }
}

/// Imbalance of energy at the end, of the largest energy.
fn imbalance(contact: &SliderContact) -> f64 {
    let energy = contact.energy.expect("the run goes on");
    energy.imbalance_j.abs() / energy.peak_j
}

/// What became of scenes.
#[derive(Clone, Debug, Default)]
struct Found {
    flown: usize,
    touched: usize,
    episodes: usize,
    /// Seeds of runs without an answer, and of runs that ended after their touch and before their window.
    undecided: Vec<u64>,
    broken: Vec<u64>,
    /// Imbalance at the end of each run to its window's end, and at [`FINE`].
    imbalance: Vec<f64>,
    /// With the number of contacts.
    imbalance_fine: Vec<(f64, usize)>,
}

impl Found {
    fn of(seed: u64) -> Self {
        let _named = OnPanic(seed);
        let mut found = Self::default();
        let Some((shock, most_pa)) = run(seed, TOLERANCE) else {
            return found;
        };
        judge(&shock);
        let contact = shock.slider_contact.as_ref().expect("rough surfaces");
        found.flown = 1;
        found.episodes = contact.episodes.len();
        match (&shock.verdict, &shock.broke_off) {
            (Verdict::Undecided { .. }, _) => found.undecided.push(seed),
            (_, Some(_)) => found.broken.push(seed),
            (verdict, None) => {
                judge_contacts(contact, most_pa);
                found.touched = usize::from(matches!(verdict, Verdict::Fails { .. }));
                found.imbalance.push(imbalance(contact));
                if seed.is_multiple_of(AGAIN) {
                    let (fine, _) = run(seed, FINE).expect("it flew");
                    judge(&fine);
                    let contact = fine.slider_contact.as_ref().expect("rough surfaces");
                    let imbalance = imbalance(contact);
                    assert!(imbalance < IMBALANCE, "{imbalance}: {:?}", contact.energy);
                    if fine.broke_off.is_none() {
                        judge_contacts(contact, most_pa);
                        found
                            .imbalance_fine
                            .push((imbalance, contact.episodes.len()));
                    }
                }
            }
        }
        found
    }

    fn and(mut self, other: Self) -> Self {
        self.flown += other.flown;
        self.touched += other.touched;
        self.episodes += other.episodes;
        self.undecided.extend(other.undecided);
        self.broken.extend(other.broken);
        self.imbalance.extend(other.imbalance);
        self.imbalance_fine.extend(other.imbalance_fine);
        self
    }
}

#[test]
fn random_contacts_give_back_no_more_than_they_took() {
    let found = (0..12).map(Found::of).fold(Found::default(), Found::and);
    assert!(found.flown >= 6 && found.touched > 1, "{found:?}");
    assert!(found.episodes > found.touched, "{found:?}");
    assert!(
        found.imbalance_fine.iter().any(|(_, n)| *n > 0),
        "{found:?}"
    );
}

#[test]
#[ignore = "slow: 2000 scenes"]
fn contacts_slow_close_their_balances() {
    let range = seeds(0..2_000);
    let mut all = Found::default();
    let numbers: Vec<u64> = range.clone().collect();
    for part in numbers.chunks(100) {
        let found = part.par_iter().map(|&seed| Found::of(seed));
        all = all.and(found.reduce(Found::default, Found::and));
        all.imbalance.sort_by(f64::total_cmp);
        all.imbalance_fine.sort_by(|a, b| a.0.total_cmp(&b.0));
        let at = |list: &[f64], share: f64| {
            let last = list.len().checked_sub(1)?;
            Some(list[(share * last as f64) as usize])
        };
        let Found {
            flown,
            touched,
            episodes,
            undecided,
            broken,
            imbalance,
            imbalance_fine,
        } = &all;
        println!(
            "contacts: {} scenes from seed {} hold, {flown} fly, undecided {undecided:?}, end after the touch and before their window \
             {broken:?}, {touched} touch and reach it, {episodes} contacts; energy imbalance, of the largest energy: median {:?}, nine in ten {:?}, all \
             {:?}; with finer steps {:?}",
            part[part.len() - 1] + 1 - range.start,
            range.start,
            at(imbalance, 0.5),
            at(imbalance, 0.9),
            at(imbalance, 1.0),
            imbalance_fine.last(),
        );
    }
    assert!(all.undecided.is_empty() && all.broken.is_empty());
    assert!(all.imbalance[all.imbalance.len() / 2] < 0.01);
}
