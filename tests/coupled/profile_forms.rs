//! GOAL: soil profiles are read as they were written, with every damping law of the crate and no other.
//! SCENE: layers with all laws, a layer on rock, a half-plane; a law of a user.
//! REFERENCE: the profile that was written.

use basemat::soil::{
    Bedrock, GeneralizedMaxwell, Hysteretic, KelvinVoigt, Kjartansson, Relaxation, SoilProfile,
};
use basemat::{Complex, Soil};
use serde_json::json;

use super::forms::{assert_errors, count_closed_objects};

/// Relaxation law of a user whose identity may begin as that of a law of the crate.
#[derive(Debug)]
struct UserRelaxation {
    identity: Option<Vec<f64>>,
}

impl Relaxation for UserRelaxation {
    fn modulus(&self, _: Complex) -> Complex {
        Complex::real(1.0)
    }
    fn identity(&self) -> Option<Vec<f64>> {
        self.identity.clone()
    }
}

/// Identities of the damping laws of all layers, and of the bedrock unless it is rigid.
fn damping_identities(profile: &SoilProfile) -> Vec<Option<Vec<f64>>> {
    let layers = profile.layers().iter().map(|layer| Some(&layer.damping));
    let bedrock = match profile.bedrock() {
        Bedrock::HalfPlane { damping, .. } => Some(damping),
        Bedrock::Rigid => None,
    };
    let laws = layers.chain([bedrock]);
    laws.map(|law| law.map(|law| law.identity().unwrap())).collect()
}

#[test]
fn profiles_with_every_law_of_the_crate() {
    let soil = Soil::new(80.0e6, 0.33, 1900.0).unwrap();
    let with_all_laws = SoilProfile::on_half_plane(soil)
        .with_bedrock_damping(Hysteretic::new(0.02).unwrap())
        .with_layer(soil, 3.0)
        .unwrap()
        .with_damping(KelvinVoigt::with_ratio(0.05, 3.0).unwrap())
        .with_layer(soil, 3.0)
        .unwrap()
        .with_damping(Kjartansson::new(0.05, 3.0).unwrap())
        .with_layer(soil, 3.0)
        .unwrap()
        .with_damping(GeneralizedMaxwell::constant_q(0.05, [0.1, 30.0], 1.0).unwrap())
        .with_layer(soil, 3.0)
        .unwrap();
    let on_rock = SoilProfile::on_rigid_bedrock().with_layer(soil, 3.0).unwrap();
    for profile in [with_all_laws, on_rock, SoilProfile::on_half_plane(soil)] {
        let text = serde_json::to_string(&profile).unwrap();
        let profile_read: SoilProfile = serde_json::from_str(&text).unwrap();
        assert_eq!(damping_identities(&profile_read), damping_identities(&profile));
        assert_eq!(format!("{profile_read:?}"), format!("{profile:?}"));
        assert_eq!(serde_json::to_string(&profile_read).unwrap(), text);
        assert!(count_closed_objects::<SoilProfile>(&serde_json::to_value(&profile).unwrap()) > 2);
    }
    let rigid_form = json!({"layers": [], "bedrock": "rigid"});
    assert_errors::<SoilProfile>(rigid_form, "list of soil layers has length 0");
    let constants = json!({"shear_modulus": 1e8, "poisson": 0.3, "density": 2e3});
    let layer = json!({"soil": constants, "thickness": -1.0, "damping": "elastic"});
    assert_errors::<SoilProfile>(json!({"layers": [layer], "bedrock": "rigid"}), "thickness");

    for identity in [None, Some(vec![]), Some(vec![17.0]), Some(vec![4.0, 1.0, 3.0, 0.1, 0.2, 0.3])]
    {
        let law = UserRelaxation { identity };
        let profile = SoilProfile::on_half_plane(soil).with_bedrock_damping(law);
        let error = serde_json::to_string(&profile).unwrap_err().to_string();
        assert!(error.contains("damping law 'user-defined law'"), "{error}");
    }
}
