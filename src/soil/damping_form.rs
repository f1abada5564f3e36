//! Damping laws in serialized scenes, by their names.

use std::any::Any;
use std::sync::Arc;

use serde::de::{Deserialize, Deserializer};
use serde::ser::{Error as _, Serialize, Serializer};

use super::maxwell::GeneralizedMaxwell;
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
    /// The form of a law; `None` for a law that the user wrote.
    fn from_law(law: &dyn Relaxation) -> Option<Self> {
        let law: &dyn Any = law;
        let elastic = law.downcast_ref().map(|Elastic| Self::Elastic);
        elastic
            .or_else(|| law.downcast_ref().copied().map(Self::KelvinVoigt))
            .or_else(|| law.downcast_ref().copied().map(Self::Kjartansson))
            .or_else(|| law.downcast_ref().copied().map(Self::Hysteretic))
            .or_else(|| law.downcast_ref().cloned().map(Self::GeneralizedMaxwell))
    }

    fn law(self) -> Arc<dyn Relaxation> {
        match self {
            Self::Elastic => Arc::new(Elastic),
            Self::KelvinVoigt(law) => Arc::new(law),
            Self::Kjartansson(law) => Arc::new(law),
            Self::Hysteretic(law) => Arc::new(law),
            Self::GeneralizedMaxwell(law) => Arc::new(law),
        }
    }
}

pub(super) fn serialize<S: Serializer>(
    law: &Arc<dyn Relaxation>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let Some(form) = DampingForm::from_law(&**law) else {
        let message = format!(
            "damping law '{}' cannot be written: it is not one of the crate's laws",
            law.describe()
        );
        return Err(S::Error::custom(message));
    };
    form.serialize(serializer)
}

pub(super) fn deserialize<'a, D: Deserializer<'a>>(
    deserializer: D,
) -> Result<Arc<dyn Relaxation>, D::Error> {
    DampingForm::deserialize(deserializer).map(DampingForm::law)
}
