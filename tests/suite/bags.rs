//! Airbags, against the closed forms of a perfect gas.

use super::command_call::call;
use super::directory;
use super::tables::{column, energy, run};
use std::fs;

/// Radius of a sphere of 60 l \[m\].
const RADIUS: f64 = 0.242_858_991_282_263_65;

/// A full bag with a hole, which touches nothing.
fn blowing_down() -> String {
    format!(
        "model: blowing-down
dimension: 3
systems:
  - name: far
    elements: [{{ name: ball, mass: 5, cg: [0, 0, 0], inertia: [0.02, 0.02, 0.02] }}]
    start: {{ position: [5, 0, 0] }}
forces:
  - airbag: bag
    ellipsoid: {{ on: frame, center: [0, 0, 0], semi_axes: [{RADIUS}, {RADIUS}, {RADIUS}] }}
    against: [{{ on: far/ball, center: [0, 0, 0], semi_axes: [0.1, 0.1, 0.1] }}]
    start: {{ pressure: 2.5 bar, temperature: 400 K }}
    vent: {{ area: 1413.72 mm^2, coefficient: 0.6 }}
outputs:
  - {{ name: p, of: airbag bag, what: pressure }}
  - {{ name: T, of: airbag bag, what: temperature }}
  - {{ name: mass, of: airbag bag, what: mass }}
  - {{ name: out, of: airbag bag, what: outflow }}
run: {{ duration: 400 ms, every: 5 ms }}
"
    )
}

fn close(what: &str, ours: f64, expected: f64, relative: f64) {
    let error = (ours - expected).abs() / expected.abs();
    assert!(error < relative, "{what}: {ours} instead of {expected}");
}

/// While the flow is choked, p/p₀ = (1 + (γ − 1)/2 k t)^(−2γ/(γ − 1)) with k = C A √(R T₀)/V · √γ
/// (2/(γ + 1))^((γ + 1)/(2(γ − 1))).
#[test]
fn a_bag_blows_down_as_a_perfect_gas_does() {
    let (table, _) = run(&blowing_down(), &["--tolerance", "1e-11"]);
    let [time, p, temperature, mass, out] =
        ["time", "p", "T", "mass", "out"].map(|name| column(&table, name));
    close("p(5 ms)", p[1], 244_334.82, 1e-7);
    close("p(10 ms)", p[2], 238_815.88, 1e-7);
    close("T(10 ms)", temperature[2], 394.8034, 1e-6);
    let (gamma, gas, volume) = (1.4_f64, 287.0_f64, 0.06);
    let choked = gamma.sqrt() * (2.0 / (gamma + 1.0)).powf((gamma + 1.0) / (2.0 * (gamma - 1.0)));
    let rate = 0.6 * 1413.72e-6 * f64::sqrt(gas * 400.0) / volume * choked;
    let critical = 101_325.0 / (2.0 / (gamma + 1.0)).powf(gamma / (gamma - 1.0));
    let mut compared = [0, 0];
    for k in 1..p.len() {
        if p[k] > critical {
            let fallen = 1.0 + (gamma - 1.0) / 2.0 * rate * time[k];
            let expected = 2.5e5 * fallen.powf(-2.0 * gamma / (gamma - 1.0));
            close("p", p[k], expected, 1e-7);
            compared[0] += 1;
        } else if p[k] > 101_500.0 {
            // Saint-Venant and Wantzel, below the critical ratio
            let r = 101_325.0 / p[k];
            let psi =
                2.0 * gamma / (gamma - 1.0) * (r.powf(2.0 / gamma) - r.powf((gamma + 1.0) / gamma));
            let expected = 0.6 * 1413.72e-6 * p[k] / f64::sqrt(gas * temperature[k]) * psi.sqrt();
            close("flow out", out[k], expected, 1e-9);
            compared[1] += 1;
        }
        // the gas in the bag expanded adiabatically: p/m^γ is constant
        close(
            "p/m^γ",
            p[k] / mass[k].powf(gamma),
            p[0] / mass[0].powf(gamma),
            1e-6,
        );
        assert!(p[k] >= 101_325.0 && p[k] <= p[k - 1]);
    }
    assert!(compared[0] > 5 && compared[1] > 5, "{compared:?}");
}

/// A ball that flies into a full bag.
const FLIGHT: &str = "model: flight
dimension: 3
parameters: { hole: { value: 0, min: 0 } }
systems:
  - name: flying
    elements: [{ name: head, mass: 5, cg: [0, 0, 0], inertia: [0.02, 0.02, 0.02] }]
    start: { position: [-0.5, 0, 0.02], velocity: [6, 0, 0] }
surfaces:
  skull: { on: flying/head, center: [0, 0, 0], semi_axes: [0.1, 0.08, 0.12] }
forces:
  - airbag: bag
    ellipsoid: { on: frame, center: [0, 0, 0], semi_axes: [0.15, 0.33, 0.33] }
    against: [skull]
    start: { pressure: 1.15 bar, temperature: 320 K }
    vent: { area: hole }
outputs:
  - { name: p, of: airbag bag, what: pressure }
  - { name: volume, of: airbag bag, what: volume }
  - { name: area, of: airbag bag, what: area }
  - { name: size, of: airbag bag, what: force, on: flying/head }
  - { name: on the frame, of: airbag bag, what: force, component: x }
  - { name: on the head, of: airbag bag, what: force, on: flying/head, component: x }
  - { name: speed, of: flying/head, what: velocity, component: x }
run: { duration: 150 ms, every: 1 ms }
";

#[test]
fn a_bag_without_a_hole_gives_back_what_it_took() {
    let (table, printed) = run(FLIGHT, &[]);
    let [p, volume, area, size] = ["p", "volume", "area", "size"].map(|name| column(&table, name));
    let [frame, head, speed] =
        ["on the frame", "on the head", "speed"].map(|name| column(&table, name));
    let whole = 4.0 / 3.0 * std::f64::consts::PI * 0.15 * 0.33 * 0.33;
    let mut pressed = 0;
    for k in 0..p.len() {
        // adiabatic: p V^γ is constant, and the force is the overpressure times the area
        close(
            "p V^γ",
            p[k] * volume[k].powf(1.4),
            1.15e5 * whole.powf(1.4),
            1e-6,
        );
        assert!((size[k] - (p[k] - 101_325.0) * area[k]).abs() < 1e-6 * (1.0 + size[k]));
        assert_eq!(frame[k], -head[k]);
        pressed += usize::from(area[k] > 0.0);
    }
    assert!(pressed > 20, "{pressed}");
    // the ball returns with the energy that it had; rotation takes a part, because it does not hit the middle
    assert!(speed[speed.len() - 1] < -5.5, "{speed:?}");
    // the pressure is integrated to the tolerance: 1e-8 of 17 kJ of gas in each of 50 steps
    assert!(
        energy(&printed, "not accounted for").abs() < 1e-2,
        "{printed}"
    );
    let (open, _) = run(FLIGHT, &["--set", "hole=0.0003"]);
    let speed = column(&open, "speed");
    assert!(
        speed[speed.len() - 1].abs() < 4.0,
        "a hole takes energy: {speed:?}"
    );
}

/// When a ball passes the middle of a bag that pushes, the direction of its force is not determined. A folded bag does
/// not push, and nothing jumps.
#[test]
fn a_ball_that_passes_the_middle_of_a_bag_is_told() {
    let directory = directory();
    let path = directory.path();
    fs::write(path.join("m.yaml"), FLIGHT).unwrap();
    let fast = ["run", "m.yaml", "--no-files", "--set", "hole=0.001"];
    let (_, said) = call(path, &fast, 3);
    assert!(
        said.contains("the direction of the force is not determined"),
        "{said}"
    );
    let folded = FLIGHT.replace(
        "start: { pressure: 1.15 bar, temperature: 320 K }",
        "inflow: { fire: late, flow: { points: [[0, 1], [1, 0]] }, temperature: 500 K }",
    ) + "switches: [{ switch: late, when: { time: 1 s } }]\n";
    let (table, _) = run(&folded, &[]);
    assert!(column(&table, "speed").iter().all(|speed| *speed == 6.0));
}

/// H = γ/(γ − 1) ṁ R T_in fills a slack bag at the ambient pressure: V = m R T_in/p_a, once the initial gas is
/// negligible.
#[test]
fn a_slack_bag_fills_at_the_pressure_around_it() {
    let filling = FLIGHT
        .replace("position: [-0.5, 0, 0.02]", "position: [-5, 0, 0]")
        .replace(
            "start: { pressure: 1.15 bar, temperature: 320 K }",
            "inflow: { fire: crash, flow: { unit: [ms, kg/s], points: [[0, 1], [20, 1], [20.001, 0]] }, temperature: 500 K }",
        )
        + "switches: [{ switch: crash, when: { time: 10 ms } }]\n";
    let (table, _) = run(&filling, &[]);
    let [p, volume] = ["p", "volume"].map(|name| column(&table, name));
    let whole = 4.0 / 3.0 * std::f64::consts::PI * 0.15 * 0.33 * 0.33;
    let begin = 1e-3 * whole;
    // a report shows it as large as its gas
    let directory = directory();
    fs::write(directory.path().join("m.yaml"), &filling).unwrap();
    let report = ["run", "m.yaml", "--no-files", "--report", "m.html"];
    call(directory.path(), &report, 0);
    let page = fs::read_to_string(directory.path().join("m.html")).unwrap();
    let data = page.split("id=\"data\">").nth(1).unwrap();
    let data: serde_json::Value =
        serde_json::from_str(data.split("</script>").next().unwrap()).unwrap();
    let ellipsoids = data["scene"]["ellipsoids"].as_array().unwrap();
    let mut bags = ellipsoids.iter().filter_map(|e| e["size"].as_array());
    let (sizes, none) = (bags.next().unwrap(), bags.next());
    assert!(none.is_none() && sizes.len() == volume.len());
    for (k, mass) in [(10, 0.0), (20, 0.010), (30, 0.020), (100, 0.0200005)] {
        assert_eq!(p[k], 101_325.0);
        let size = sizes[k].as_f64().unwrap();
        let gas = begin + mass * 287.0 * 500.0 / 101_325.0;
        close("size", size.powi(3) * whole, gas, 1e-4);
        close(
            "volume",
            volume[k],
            begin + mass * 287.0 * 500.0 / 101_325.0,
            1e-6,
        );
    }
}

/// A body that is in the bag at the start displaces volume, and the pressure has the requested value.
#[test]
fn a_bag_is_full_around_what_is_in_it_at_the_start() {
    let inside = FLIGHT.replace("position: [-0.5, 0, 0.02]", "position: [-0.12, 0, 0.02]");
    let (table, _) = run(&inside, &["--duration", "1 ms"]);
    let whole = 4.0 / 3.0 * std::f64::consts::PI * 0.15 * 0.33 * 0.33;
    close("p", column(&table, "p")[0], 1.15e5, 1e-12);
    assert!(column(&table, "volume")[0] < whole && column(&table, "area")[0] > 0.0);
}

#[test]
fn what_is_wrong_with_a_bag_is_said() {
    let directory = directory();
    let path = directory.path();
    for (wrong, instead, said) in [
        (
            "start: { pressure: 1.15 bar, temperature: 320 K }",
            "enabled: true",
            "nothing fills airbag \"bag\"",
        ),
        (
            "pressure: 1.15 bar",
            "pressure: 0.9 bar",
            "must be at least that around the bag",
        ),
        (", temperature: 320 K", "", "lacks the key \"temperature\""),
        ("temperature: 320 K", "temperature: 320 N", "a temperature"),
        (
            "vent: { area: hole }",
            "gas: { gamma: 1 }",
            "must be more than 1",
        ),
        (
            "vent: { area: hole }",
            "vent: { area: -1 }",
            "must not be negative",
        ),
        (
            "against: [skull]",
            "against: [scull]",
            "there is no surface \"scull\"",
        ),
        (
            "on: frame, center",
            "on: flying/head, center",
            "on the same body",
        ),
        (
            "what: force, component: x",
            "what: force, on: man/head",
            "man",
        ),
        (
            "semi_axes: [0.15, 0.33, 0.33]",
            "semi_axes: [0.15, 0.33, 0.33], degree: 4",
            "are of degree 2",
        ),
    ] {
        assert!(FLIGHT.contains(wrong), "{wrong}");
        fs::write(path.join("m.yaml"), FLIGHT.replacen(wrong, instead, 1)).unwrap();
        let (_, printed) = call(path, &["check", "m.yaml"], 2);
        assert!(printed.contains(said), "{said}: {printed}");
    }
    // gas that flows backwards, by a factor or beyond the last point
    for flow in [
        "{ curve: { points: [[0, 1], [0.1, 0]] }, times: -1 }",
        "{ points: [[0, 1], [0.1, 0]], extrapolate: linear }",
    ] {
        let inflow = format!("inflow: {{ fire: crash, flow: {flow}, temperature: 500 }}");
        let wrong = FLIGHT.replace("vent: { area: hole }", &inflow);
        let wrong = wrong + "switches: [{ switch: crash, when: { time: 1 ms } }]\n";
        fs::write(path.join("m.yaml"), wrong).unwrap();
        let (_, printed) = call(path, &["check", "m.yaml"], 2);
        assert!(printed.contains("negative"), "{printed}");
    }
    fs::write(path.join("m.yaml"), FLIGHT).unwrap();
    call(
        path,
        &["run", "m.yaml", "--set", "hole=-1", "--no-files"],
        2,
    );
}
