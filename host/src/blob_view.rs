//! Camera and lights of a blob in scene units. They are read from a blob, and placed in it as a program on a device
//! places its own.

use crate::compile::{CompileError, light_record, place};
use crate::scene::{Camera, Lens, Light};
use crate::shape::{Lattice, exp2};
use glam::DVec3;
use gridel_core::Scene;
use gridel_core::format::record::{self, View};

impl Camera {
    /// Returns the camera of a blob. The target lies in the middle of the picture, as deep as the middle of the scene.
    /// Up is an axis if the camera stands upright on it.
    ///
    /// ```
    /// # use gridel_host::compile::{Options, compile};
    /// # let file = "[[object]]\nkind = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\n\
    /// #     [camera]\neye = [0, 0, 5]\ntarget = [0, 0, 0]\nfov = 40";
    /// # let imported = gridel_host::scene::read("ball.toml".as_ref(), file.into(), &Default::default())?;
    /// # let blob = compile(&imported.scene, &Options::default())?.blob;
    /// # let scene = blob.scene()?;
    /// use gridel_host::scene::Camera;
    ///
    /// let camera = Camera::of_blob(&scene);
    /// assert_eq!(camera.eye.to_array(), [0.0, 0.0, 5.0]);
    /// assert!((camera.fov_degrees - 40.0).abs() < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of_blob(scene: &Scene<'_>) -> Self {
        let view = scene.view();
        let lattice = Lattice::of_blob(scene);
        let [forward, up] = [view.forward, view.up].map(vector);
        let eye = lattice.place(view.eye);
        let direction = forward.normalize();
        let [low, high] =
            [0, 1].map(|side| scene.bounds().0.map(|axis| i64::from(axis[side]) << 13));
        let [low, high] = [low, high].map(|corner| lattice.place(corner));
        let depth = (low.midpoint(high) - eye).dot(direction);
        // From within or behind the scene, anything ahead.
        let depth = if depth > 0.0 {
            depth
        } else {
            (high - low).max_element().max(lattice.unit())
        };
        Self {
            eye,
            target: eye + depth * direction,
            up: upright(view).unwrap_or(up),
            fov_degrees: 2.0 * libm::atan2(up.length(), forward.length()).to_degrees(),
        }
    }

    /// Returns the view of a blob with this camera in place of its own. It equals a blob compiled with this camera, bit
    /// for bit.
    ///
    /// # Errors
    /// If the camera has no direction or looks along up, or its eye lies beyond the blob's scene coordinates.
    pub fn in_blob(&self, scene: &Scene<'_>) -> Result<View, CompileError> {
        Ok(place(self, scene.header())?.view(scene))
    }
}

impl Lens {
    /// Returns the lens of a blob's camera; `None` for a pinhole. A camera that moves keeps its focus.
    pub fn of_blob(scene: &Scene<'_>) -> Option<Self> {
        let lens = scene.lens()?;
        let step = Lattice::of_blob(scene).unit() * exp2(-13);
        let [radius, focus] = [lens.radius, lens.focus].map(|it| it as f64 * step);
        Some(Self {
            radius,
            focus: Some(focus),
        })
    }
}

/// Returns the axis across which the picture's rows run. Its sign is that of the direction up.
fn upright(view: &View) -> Option<DVec3> {
    let across = (0..3).filter(|&axis| view.right[axis].abs() <= 1 && view.up[axis] != 0);
    let axis = across.max_by_key(|&axis| view.up[axis].abs())?;
    Some(DVec3::AXES[axis] * f64::from(view.up[axis].signum()))
}

impl Light {
    /// Returns a light of a blob.
    pub fn of_blob(scene: &Scene<'_>, light: &record::Light) -> Self {
        let color = light.color.map(|channel| f64::from(channel) / exp2(20));
        if light.kind == record::Light::DIRECTIONAL {
            let direction = -DVec3::from_array(light.vector.map(|x| x as f64));
            Self::Directional { direction, color }
        } else {
            let position = Lattice::of_blob(scene).place(light.vector);
            Self::Point { position, color }
        }
    }

    /// Returns this light as a record of a blob.
    ///
    /// # Errors
    /// If it lies too far away.
    pub fn in_blob(&self, scene: &Scene<'_>, number: usize) -> Result<record::Light, CompileError> {
        let sides = scene
            .bounds()
            .0
            .map(|[low, high]| f64::from(high) - f64::from(low));
        let lattice = Lattice::of_blob(scene);
        let size = sides.into_iter().fold(0.0, f64::max) * lattice.unit();
        let record = light_record(self, &lattice, size, number)?;
        let form = scene
            .lights()
            .get(number)
            .filter(|it| it.form().is_some() || it.is_environment());
        Ok(match form {
            Some(light) if record.kind == 0 => record::Light {
                kind: light.kind,
                ..record
            },
            _ => record,
        })
    }
}

impl Lattice {
    /// The lattice of a blob.
    fn of_blob(scene: &Scene<'_>) -> Self {
        let header = scene.header();
        Self {
            bits: header.lattice_bits,
            unit_exponent: header.unit_exponent,
            origin: DVec3::from_array(header.origin),
        }
    }

    /// A place in units with 13 fraction bits, in scene units.
    fn place(&self, q13: [i64; 3]) -> DVec3 {
        self.origin + DVec3::from_array(q13.map(|x| x as f64)) * (self.unit() * exp2(-13))
    }
}

fn vector(components: [i32; 3]) -> DVec3 {
    DVec3::from_array(components.map(f64::from))
}
