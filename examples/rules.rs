//! Which harmonics of the mesh frequency may excite rotational, translational and planet modes, from tooth numbers and
//! planet positions alone.
//!
//! `cargo run --release --example rules`

use std::error::Error;

use epicyclic::gearset::{Scene, SceneKind, excitation_of_scene, template};

fn main() -> Result<(), Box<dyn Error>> {
    let set = Scene::from_toml(template(SceneKind::Planetary))?;
    println!("{}", set.title);
    println!("harmonic  rotational  translational  planet");
    for harmonic in excitation_of_scene(&set, 10).ok_or("the set has no tooth numbers")? {
        let allowed = harmonic.allowed();
        let [rotational, translational, planet] =
            [allowed.rotational, allowed.translational, allowed.planet]
                .map(|is_allowed| if is_allowed { "yes" } else { "–" });
        println!("{:8}  {rotational:10}  {translational:13}  {planet}", harmonic.harmonic);
    }
    Ok(())
}
