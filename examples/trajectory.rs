//! Prints the default crossing of the coupled core as CSV, each number with all its digits:
//! `cargo run --release --example trajectory`.

use rps3::dynamics::STATES;
use rps3::models::plant::table::state_names;
use rps3::study::trajectory;

fn main() -> anyhow::Result<()> {
    let voltages = ["v_leg1", "v_leg2", "v_leg3", "v_rev1", "v_rev2", "v_rev3"];
    let names: [String; STATES] = state_names().try_into().expect("a name for each state");
    println!("{},{}", names.join(","), voltages.join(","));
    for sample in trajectory()? {
        let numbers: Vec<_> = sample.state.iter().chain(&sample.voltages).map(|x| format!("{x:?}")).collect();
        println!("{}", numbers.join(","));
    }
    Ok(())
}
