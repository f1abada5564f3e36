//! Profiles in serde's formats: their damping laws by name.

use std::any::Any;
use std::sync::Arc;

use serde::de::{Deserialize, Deserializer, Error as _};
use serde::ser::{Error as _, Serialize, Serializer};

use super::Soil;
use super::maxwell::GeneralizedMaxwell;
use super::profile::{Base, SoilLayer, SoilProfile};
use super::relaxation::{Elastic, Hysteretic, KelvinVoigt, Kjartansson, Relaxation};

/// The crate's damping laws.
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
enum DampingForm {
    Elastic,
    KelvinVoigt(KelvinVoigt),
    Kjartansson(Kjartansson),
    Hysteretic(Hysteretic),
    GeneralizedMaxwell(GeneralizedMaxwell),
}

impl DampingForm {
    /// The form of a law; `None` for a user's own.
    fn of(law: &dyn Relaxation) -> Option<Self> {
        let law: &dyn Any = law;
        let elastic = law.downcast_ref().map(|Elastic| Self::Elastic);
        elastic
            .or_else(|| law.downcast_ref().copied().map(Self::KelvinVoigt))
            .or_else(|| law.downcast_ref().copied().map(Self::Kjartansson))
            .or_else(|| law.downcast_ref().copied().map(Self::Hysteretic))
            .or_else(|| law.downcast_ref().cloned().map(Self::GeneralizedMaxwell))
    }

    fn law(&self) -> Arc<dyn Relaxation> {
        match self {
            Self::Elastic => Arc::new(Elastic),
            Self::KelvinVoigt(law) => Arc::new(*law),
            Self::Kjartansson(law) => Arc::new(*law),
            Self::Hysteretic(law) => Arc::new(*law),
            Self::GeneralizedMaxwell(law) => Arc::new(law.clone()),
        }
    }
}

#[derive(serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct LayerForm {
    soil: Soil,
    thickness: f64,
    damping: DampingForm,
}

#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum BaseForm {
    HalfPlane { soil: Soil, damping: DampingForm },
    Rigid,
}

#[derive(serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct ProfileForm {
    layers: Vec<LayerForm>,
    base: BaseForm,
}

/// A profile whose damping laws are the crate's; others are an error.
impl Serialize for SoilProfile {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let form = |law: &Arc<dyn Relaxation>| {
            let unknown =
                || format!("damping law '{}' has no form to be written in", law.describe());
            DampingForm::of(&**law).ok_or_else(|| S::Error::custom(unknown()))
        };
        let layer = |own: &SoilLayer| {
            let damping = form(&own.damping)?;
            Ok(LayerForm { soil: own.soil, thickness: own.thickness, damping })
        };
        let base = match self.base() {
            Base::HalfPlane { soil, damping } => {
                BaseForm::HalfPlane { soil: *soil, damping: form(damping)? }
            }
            Base::Rigid => BaseForm::Rigid,
        };
        let layers = self.layers().iter().map(layer).collect::<Result<_, S::Error>>()?;
        ProfileForm { layers, base }.serialize(to)
    }
}

/// Through [`SoilProfile::new`].
impl<'a> Deserialize<'a> for SoilProfile {
    fn deserialize<D: Deserializer<'a>>(from: D) -> Result<Self, D::Error> {
        let form = ProfileForm::deserialize(from)?;
        let layer = |own: LayerForm| {
            let LayerForm { soil, thickness, damping } = own;
            SoilLayer { soil, thickness, damping: damping.law() }
        };
        let base = match form.base {
            BaseForm::HalfPlane { soil, damping } => {
                Base::HalfPlane { soil, damping: damping.law() }
            }
            BaseForm::Rigid => Base::Rigid,
        };
        Self::new(form.layers.into_iter().map(layer).collect(), base).map_err(D::Error::custom)
    }
}
