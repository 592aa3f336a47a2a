use super::*;
use crate::scene::read;

/// A scene of joints in a chain, the last of which has an instance; `scales` are the values of their tracks.
fn chain(scales: &[&str]) -> Scene {
    let mut file = String::from(
        "ambient = 1\n[[part]]\nname = 'p'\nobject = [{ kind = 'sphere', center = [0, 0, 0], radius = 1 }]\n\
         [[joint]]\nname = 'base'\n",
    );
    for number in 0..scales.len() {
        let parent = match number {
            0 => String::from("base"),
            _ => format!("j{}", number - 1),
        };
        file += &format!("[[joint]]\nname = 'j{number}'\nparent = '{parent}'\n");
    }
    for (number, values) in scales.iter().enumerate() {
        file += &format!(
            "[[track]]\ntarget = 'joint.j{number}.scale'\ntimes = [0, 1]\nvalues = {values}\n"
        );
    }
    file += &format!(
        "[[instance]]\npart = 'p'\njoint = 'j{}'\n",
        scales.len() - 1
    );
    read(
        "chain.toml".as_ref(),
        file.into_bytes(),
        &Default::default(),
    )
    .unwrap()
    .scene
}

#[test]
fn chains_whose_scales_leave_the_range_are_rejected() {
    for (scales, joint, said) in [
        (&["[1, 10]", "[1, 10]"][..], "j1", "100 times"),
        (
            &["[64, 64]", "[64, 64]", "[0.015625, 0.015625]"],
            "j1",
            "4096 times",
        ),
    ] {
        let error = check(&chain(scales)).unwrap_err();
        let CompileError::Joint {
            name,
            cause,
            remedy,
        } = &error
        else {
            panic!("{error}");
        };
        assert_eq!(name, joint);
        assert!(
            cause.contains(said) && remedy.contains("--instances flatten"),
            "{error}"
        );
    }
}

#[test]
fn chains_whose_scales_stay_in_the_range_are_accepted() {
    for scales in [
        &["[1, 8]", "[1, 8]"][..],
        &["[64, 64]", "[0.5, 1]"],
        // Nothing is left that could be seen to grow.
        &["[1, 0.0001]", "[1, 0.0001]", "[1, 1.5]"],
    ] {
        check(&chain(scales)).unwrap();
    }
}

#[test]
fn scales_of_joints_that_move_nothing_are_not_limited() {
    let mut scene = chain(&["[1, 10]", "[1, 10]"]);
    scene.instances[0].joint = Some(1);
    check(&scene).unwrap();
}

#[test]
fn chains_of_too_many_joints_are_rejected_with_their_number() {
    let mut scene = chain(&["[1, 1]"]);
    let last = scene.joints[1].clone();
    let mut longer = |count: usize| {
        while scene.joints.len() < count {
            let parent = Some(scene.joints.len() - 1);
            scene.joints.push(Joint {
                parent,
                ..last.clone()
            });
        }
        check(&scene)
    };
    longer(1024).unwrap();
    let error = longer(1025).unwrap_err().to_string();
    assert!(
        error.ends_with("stands in a chain of more than 1024 joints"),
        "{error}"
    );
}
