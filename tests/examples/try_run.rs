//! x
use opshock_solver::simulation::*;
use opshock_tests::scenes;
use std::time::Instant;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let ramp = &a[1]; let width: f64 = a[2].parse().unwrap(); let g: f64 = a[3].parse().unwrap();
    let mut sets: Vec<(&str,&str)> = vec![];
    for s in &a[4..] { let (k,v)=s.split_once('=').unwrap(); sets.push((k,v)); }
    let scene = scenes::scene("fig13", ramp, width, &sets);
    let t = Instant::now();
    let model = Model::build(&scene, Scope::Full, None).unwrap();
    let b = t.elapsed().as_secs_f64();
    let f = &model.bearing().unwrap().flight;
    println!("build {b:.3} s cells {} hmin {:.3} nm pitch {:.2} urad it {} others {:?} modes {}", model.bearing().unwrap().film.n_cells(), f.min_clearance_m*1e9, f.attitude.pitch_rad*1e6, f.n_iterations, f.others.iter().map(|o| o.min_clearance_m*1e9).collect::<Vec<_>>(), model.structure().n_modes());
    println!("onset + {:?} - {:?}", model.structure().touch_amplitude_m_per_s2(true).map(|x| x/9.80665), model.structure().touch_amplitude_m_per_s2(false).map(|x| x/9.80665));
    let t = Instant::now();
    let mut w = Workspace::default();
    let o = simulate(&model, &Request{amplitude_m_per_s2: g*9.80665, stop_at_failure: true, record: false}, &mut w);
    println!("run {:.3} s verdict {:?}\n hmin {:?} at {:?}\n disk {:?}\n top {:?}\n bottom {:?}\n dimple {:?}\n cost {:?}\n energy {:?}\n comp {:?} {:?}", t.elapsed().as_secs_f64(), o.verdict, o.min_clearance_m, o.t_min_clearance_s, o.disk, o.top, o.bottom, o.dimple, o.cost, o.energy, o.complementarity, o.warnings);
}
