//! The topics of a recording: what each is called, how its messages are encoded.

/// One topic, which is one channel of the MCAP file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Topic {
    /// The garments as drawn.
    Cloth,
    /// Material coordinates per triangle corner.
    Material,
    /// Named rigid transforms, the camera's among them.
    Transforms,
    /// Camera intrinsics.
    Camera,
    /// Frame index and exact time.
    Mark,
    /// The caller's report; the last message of a frame.
    Report,
    /// Exact state.
    Checkpoint,
    /// The obstacles as drawn.
    Obstacles,
    /// The particles of a fluid; last, as the order gives the numbers in the file.
    Fluid,
}

impl Topic {
    pub(crate) const ALL: [Self; 9] = [
        Self::Cloth,
        Self::Material,
        Self::Transforms,
        Self::Camera,
        Self::Mark,
        Self::Report,
        Self::Checkpoint,
        Self::Obstacles,
        Self::Fluid,
    ];

    /// What a frame has before its mark.
    pub(crate) const GEOMETRY: [Self; 6] =
        [Self::Cloth, Self::Material, Self::Obstacles, Self::Fluid, Self::Transforms, Self::Camera];

    /// Topic name in the file.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Cloth => "/cloth",
            Self::Material => "/cloth/material",
            Self::Transforms => "/tf",
            Self::Camera => "/camera",
            Self::Mark => "/frame",
            Self::Report => "/report",
            Self::Checkpoint => "/checkpoint",
            Self::Obstacles => "/obstacles",
            Self::Fluid => "/fluid",
        }
    }

    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|topic| topic.name() == name)
    }

    /// Full name of the message type.
    pub(crate) const fn schema_name(self) -> &'static str {
        match self {
            Self::Cloth | Self::Obstacles => "foxglove.SceneUpdate",
            Self::Material => "organza.ClothMaterial",
            Self::Fluid => "foxglove.PointCloud",
            Self::Transforms => "foxglove.FrameTransforms",
            Self::Camera => "foxglove.CameraCalibration",
            Self::Mark => "organza.FrameMark",
            Self::Report => "organza.Report",
            Self::Checkpoint => "organza.Checkpoint",
        }
    }

    /// Encodings of message and schema, as the MCAP registry calls them.
    pub(crate) const fn encodings(self) -> (&'static str, &'static str) {
        match self {
            Self::Report => ("json", "jsonschema"),
            _ => ("protobuf", "protobuf"),
        }
    }

    pub(crate) fn schema(self) -> Vec<u8> {
        match self {
            Self::Report => br#"{"title":"organza.Report","type":"object"}"#.to_vec(),
            _ => crate::schema::descriptor_set(self.schema_name()),
        }
    }

    /// Number of its channel in the file, from 1 on: part of the format.
    pub(crate) const fn id(self) -> u16 {
        self as u16 + 1
    }

    /// Number of its schema in the file: that of the first topic with this type of message.
    pub(crate) const fn schema_id(self) -> u16 {
        match self {
            Self::Obstacles => Self::Cloth.id(),
            _ => self.id(),
        }
    }
}

/// A set of topics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct TopicSet(u16);

impl TopicSet {
    pub(crate) fn insert(&mut self, topic: Topic) {
        self.0 |= 1 << topic as u8;
    }

    pub(crate) fn contains(self, topic: Topic) -> bool {
        self.0 & (1 << topic as u8) != 0
    }

    /// Has a message that a frame has before its mark.
    pub(crate) fn has_geometry(self) -> bool {
        Topic::GEOMETRY.iter().any(|t| self.contains(*t))
    }

    /// Has a message that ends a frame.
    pub(crate) fn closes_frame(self) -> bool {
        self.contains(Topic::Mark) || self.contains(Topic::Report)
    }

    /// Has messages, all of which a frame has before its mark.
    pub(crate) fn is_only_geometry(self) -> bool {
        self.has_geometry() && !self.closes_frame() && !self.contains(Topic::Checkpoint)
    }
}

impl Extend<Topic> for TopicSet {
    fn extend<I: IntoIterator<Item = Topic>>(&mut self, topics: I) {
        topics.into_iter().for_each(|topic| self.insert(topic));
    }
}
