//! Every error: its line, its cause and its remedy.

use super::refusal;
use miette::{GraphicalReportHandler, GraphicalTheme};

/// Each text must be refused at the line, with words in the cause and in the remedy.
fn check(cases: &[(&str, usize, &str, &str)]) {
    for &(text, line, cause, remedy) in cases {
        let error = refusal(text);
        assert_eq!(error.line, Some(line), "{error}\n{text}");
        assert!(error.file.ends_with("scene.toml"));
        assert!(
            error.cause.contains(cause),
            "{error}; {}\n{text}",
            error.remedy
        );
        assert!(
            error.remedy.contains(remedy),
            "{error}; {}\n{text}",
            error.remedy
        );
    }
}

/// Errors of one object: its keys after `kind`, and the words; the object starts in line 1.
fn check_objects(cases: &[(&str, usize, &str, &str)]) {
    for &(keys, line, cause, remedy) in cases {
        let text = format!("[[object]]\nkind = {keys}\n");
        check(&[(text.as_str(), line, cause, remedy)]);
    }
}

#[test]
fn keys() {
    check(&[
        (
            "backgruond = 0",
            1,
            "this scene has no key `backgruond`",
            "did you mean `background`?",
        ),
        (
            "[camera]\neye = [0, 0, 1]\ntarget = [0, 0, 0]\nfow = 3",
            4,
            "this camera has no key `fow`",
            "did you mean `fov`?",
        ),
        (
            "[render]\nsample = 3",
            2,
            "this render table has no key `sample`",
            "did you mean `samples`?",
        ),
        (
            "[material.a]\n\ncolour = 1",
            3,
            "this material has no key `colour`",
            "The keys are diffuse, checker",
        ),
        (
            "[material.a]\nchecker = { even = 0, odd = 1, siez = 2 }",
            2,
            "this checker has no key `siez`",
            "`size`",
        ),
        (
            "[[light]]\nkind = \"point\"\nposition = [0, 0, 0]\ncolor = 1\ncolour = 1",
            5,
            "this light has no key `colour`",
            "`color`",
        ),
        (
            "[group.a]\nobjects = []",
            2,
            "this group has no key `objects`",
            "`object`",
        ),
        (
            "[camera]\ntarget = [0, 0, 0]",
            1,
            "this camera has no `eye`",
            "add a line `eye = ...`",
        ),
        (
            "[camera]\neye = [0, 0, 0]",
            1,
            "this camera has no `target`",
            "add a line `target",
        ),
        (
            "background = 0\nbackground = 1",
            2,
            "this is not TOML: duplicate key",
            "key = value",
        ),
        ("a = ", 1, "this is not TOML", "key = value"),
    ]);
    check_objects(&[
        (
            "\"sphere\"\ncentre = [0, 0, 0]\nradius = 1",
            3,
            "this sphere has no key `centre`",
            "did you mean `center`?",
        ),
        (
            "\"sphere\"\ncenter = [0, 0, 0]",
            1,
            "this sphere has no `radius`",
            "add a line `radius = ...`",
        ),
        (
            "\"box\"\nmin = [0, 0, 0]\nmax = [1, 1, 1]\nradius = 1",
            5,
            "this box has no key `radius`",
            "min, max",
        ),
        (
            "\"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nrotate = { axes = [0, 0, 1], degrees = 1 }",
            5,
            "this rotation has no key `axes`",
            "`axis`",
        ),
        (
            "\"import\"\nname = \"x\"",
            1,
            "this import has no `file`",
            "`file = ...`",
        ),
    ]);
}

#[test]
fn types() {
    check(&[
        (
            "background = true",
            1,
            "`background` holds a boolean; expected three numbers or one",
            "[0.8, 0.1, 0.1]",
        ),
        (
            "ambient = [1, 2]",
            1,
            "`ambient` holds an array of 2; expected three numbers or one",
            "0.5",
        ),
        (
            "camera = 3",
            1,
            "`camera` holds an integer; expected a table",
            "heading",
        ),
        (
            "[[camera]]\n",
            1,
            "`camera` holds an array of 1; expected a table",
            "heading",
        ),
        (
            "[light]\nkind = \"point\"",
            1,
            "`light` holds a table; expected an array",
            "`[[light]]`",
        ),
        (
            "[object]\nkind = \"sphere\"",
            1,
            "`object` holds a table; expected an array",
            "`[[object]]`",
        ),
        (
            "object = [3]",
            1,
            "`object` holds an integer; expected a table with keys",
            "{ key = value }",
        ),
        (
            "material = [1]",
            1,
            "`material` holds an array of 1; expected a table",
            "heading",
        ),
        (
            "[material]\na = 3",
            2,
            "`a` holds an integer; expected a table with keys",
            "heading",
        ),
        (
            "[render]\nsamples = 1.5",
            2,
            "`samples` holds a float; expected an integer",
            "`samples = 1`",
        ),
        (
            "[material.a]\nabsorption = \"#ffffff\"",
            2,
            "`absorption` holds a string; expected three numbers or one",
            "0.5",
        ),
        (
            "[material.a]\nior = \"1.5\"",
            2,
            "`ior` holds a string; expected a number",
            "`ior = 1.5`",
        ),
        (
            "[[light]]\nkind = 3",
            2,
            "`kind` holds an integer; expected text",
            "\"...\"",
        ),
    ]);
    check_objects(&[
        (
            "\"sphere\"\ncenter = 3",
            3,
            "`center` holds an integer; expected three numbers",
            "[0, 1, 0]",
        ),
        (
            "\"sphere\"\ncenter = [0, 0]",
            3,
            "`center` holds an array of 2; expected three numbers",
            "[0, 1, 0]",
        ),
        (
            "\"sphere\"\ncenter = [0, 0, \"1\"]",
            3,
            "`center` holds a string; expected a number",
            "1.5",
        ),
        (
            "\"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nrotate = 90",
            5,
            "`rotate` holds an integer; expected angles",
            "{ axis",
        ),
        (
            "\"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nscale = true",
            5,
            "`scale` holds a boolean; expected a number",
            "1.5",
        ),
        (
            "\"mesh\"\nvertices = [[0, 0, 0]]\nfaces = 3",
            4,
            "`faces` holds an integer; expected an array",
            "[0, 1, 2]",
        ),
        (
            "\"mesh\"\nvertices = [[0, 0, 0]]\nfaces = [3]",
            4,
            "`faces` holds an integer; expected an array",
            "[0, 1, 2]",
        ),
        (
            "\"triangle\"\nvertices = [[0, 0, 0]]",
            3,
            "`vertices` holds an array of 1; expected three points",
            "vertices = ",
        ),
        (
            "\"group\"\nobject = 3",
            3,
            "`object` holds an integer; expected an array",
            "`[[object]]`",
        ),
    ]);
}

#[test]
fn numbers() {
    for number in ["nan", "inf", "-inf", "1e999"] {
        check(&[(
            &format!("[render]\n\ncutoff = {number}"),
            3,
            "`cutoff` is not a finite number",
            "`inf` or `nan`",
        )]);
        let sphere = format!("\"sphere\"\ncenter = [0, {number}, 0]");
        check_objects(&[(&sphere, 3, "`center` is not a finite number", "64-bit")]);
    }
    let camera = "[camera]\neye = [0, 0, 1]\ntarget = [0, 0, 0]\n";
    let ranges = [
        (
            format!("{camera}fov = 0"),
            4,
            "`fov` is 0 degrees",
            "such as 45",
        ),
        (
            format!("{camera}fov = 180"),
            4,
            "`fov` is 180 degrees",
            "such as 45",
        ),
        (
            format!("{camera}fov = -20.5"),
            4,
            "`fov` is -20.5 degrees",
            "such as 45",
        ),
        (
            format!("{camera}up = [0, 0, -3]"),
            4,
            "the camera looks along `up`",
            "across the view",
        ),
        (
            format!("{camera}up = [0, 0, 0]"),
            4,
            "points nowhere",
            "above 0",
        ),
    ];
    for (text, line, cause, remedy) in ranges {
        check(&[(&text, line, cause, remedy)]);
    }
    check(&[
        (
            "[camera]\neye = [1, 1, 1]\ntarget = [1, 1, 1]",
            3,
            "are the same point",
            "move one of them",
        ),
        (
            "[camera]\neye = [0, 5, 0]\ntarget = [0, 0, 0]",
            3,
            "the camera looks along `up`",
            "[0, 0, 1]",
        ),
        (
            "[camera]\neye = [1e308, 0, 0]\ntarget = [-1e308, 0, 0]",
            3,
            "too far apart",
            "nearer",
        ),
        (
            "[render]\nsamples = 0",
            2,
            "`samples` is 0; it must be from 1 to 256",
            "from 1 to 256",
        ),
        (
            "[render]\nsamples = 257",
            2,
            "`samples` is 257",
            "from 1 to 256",
        ),
        (
            "[render]\nsamples = -1",
            2,
            "`samples` is -1",
            "from 1 to 256",
        ),
        (
            "[render]\ndepth = 17",
            2,
            "`depth` is 17; it must be from 0 to 16",
            "from 0 to 16",
        ),
        ("[render]\nwidth = 0", 2, "`width` is 0", "from 1 to 65535"),
        (
            "[render]\nheight = 99999999999999999999999",
            2,
            "`height` is 9999",
            "from 1 to 65535",
        ),
        (
            "[render]\ncutoff = -0.1",
            2,
            "`cutoff` is -0.1",
            "from 0 to 1",
        ),
        (
            "[material.a]\nshininess = 0",
            2,
            "`shininess` is 0",
            "from 1 to 1024",
        ),
        (
            "[material.a]\nshininess = 1025",
            2,
            "`shininess` is 1025",
            "from 1 to 1024",
        ),
        ("[material.a]\nior = 0.9", 2, "`ior` is 0.9", "from 1 to 4"),
        ("[material.a]\nior = 4.1", 2, "`ior` is 4.1", "from 1 to 4"),
        (
            "[material.a]\ndiffuse = [0, -1, 0]",
            2,
            "`diffuse` has the negative channel -1",
            "at or above 0",
        ),
        (
            "[material.a]\nmirror = -0.5",
            2,
            "`mirror` has the negative channel -0.5",
            "at or above 0",
        ),
        (
            "[material.a]\nchecker = { even = 0, odd = 1, size = 0 }",
            2,
            "`size` is 0; it must be above 0",
            "above 0",
        ),
        (
            "[material.a]\ndiffuse = 0\nchecker = { even = 0, odd = 1 }",
            3,
            "either a `diffuse` colour or a `checker`",
            "remove one",
        ),
        (
            "background = \"#ff00\"",
            1,
            "\"#ff00\", which is no colour",
            "six hexadecimal digits",
        ),
        (
            "background = \"#+f00ff\"",
            1,
            "which is no colour",
            "six hexadecimal digits",
        ),
        (
            "background = \"#ééé\"",
            1,
            "which is no colour",
            "six hexadecimal digits",
        ),
        (
            "background = \"red\"",
            1,
            "\"red\", which is no colour",
            "#rrggbb",
        ),
        (
            "[[light]]\nkind = \"directional\"\ndirection = [0, 0, 0]",
            3,
            "points nowhere",
            "above 0",
        ),
        (
            "[[light]]\nkind = \"point\"\nposition = [0, 0, 0]\ndirection = [0, 1, 0]",
            4,
            "has no `direction`",
            "change the light's `kind`",
        ),
        (
            "[[light]]\nkind = \"spot\"",
            2,
            "`kind` is \"spot\"",
            "point, directional",
        ),
    ]);
}

#[test]
fn shapes() {
    check_objects(&[
        (
            "\"shpere\"",
            2,
            "`kind` is \"shpere\"",
            "did you mean \"sphere\"?",
        ),
        (
            "\"sphere\"\ncenter = [0, 0, 0]\nradius = 0",
            4,
            "`radius` is 0; it must be above 0",
            "above 0",
        ),
        (
            "\"disc\"\ncenter = [0, 0, 0]\nnormal = [0, 1, 0]\nradius = -1",
            5,
            "`radius` is -1",
            "above 0",
        ),
        (
            "\"disc\"\ncenter = [0, 0, 0]\nnormal = [0, 0, 0]\nradius = 1",
            4,
            "points nowhere",
            "above 0",
        ),
        (
            "\"frustum\"\nbase = [0, 0, 0]\ntop = [0, 1, 0]\nbase_radius = 1\ntop_radius = 0",
            6,
            "`top_radius` is 0",
            "above 0",
        ),
        (
            "\"cone\"\nbase = [0, 1, 0]\napex = [0, 1, 0]\nradius = 1",
            4,
            "`base` and `apex` are the same point",
            "move them apart",
        ),
        (
            "\"cylinder\"\nbase = [0, 1, 0]\ntop = [0, 1, 0]\nradius = 1",
            4,
            "`base` and `top` are the same point",
            "use a disc",
        ),
        (
            "\"box\"\nmin = [0, 2, 0]\nmax = [1, 1, 1]",
            3,
            "the box is empty: on y `min` is 2 and `max` is 1",
            "the smaller number",
        ),
        (
            "\"box\"\nmin = [0, 0, 0]\nmax = [0, 0, 1]",
            4,
            "no surface",
            "at least two axes",
        ),
        (
            "\"triangle\"\nvertices = [[0, 0, 0], [1, 1, 1], [2, 2, 2]]",
            3,
            "no area",
            "off that line",
        ),
        (
            "\"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nscale = 0",
            5,
            "a scale of 0",
            "mirror",
        ),
        (
            "\"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nscale = [1, 0, 1]",
            5,
            "a scale of 0",
            "mirror",
        ),
        (
            "\"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nscale = [1, 2, 1]",
            1,
            "\"sphere 1\" is scaled unevenly",
            "or use a mesh",
        ),
        (
            "\"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nrotate = { axis = [0, 0, 0], degrees = 9 }",
            5,
            "points nowhere",
            "above 0",
        ),
        (
            "\"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nname = \"\"",
            5,
            "`name` is empty",
            "between the quotes",
        ),
    ]);
    let square =
        "\"mesh\"\nvertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0]]\nfaces = ";
    for (faces, cause, remedy) in [
        ("[]", "this mesh has no face", "add faces"),
        (
            "[[0, 1]]",
            "this face has 2 vertices; it must have from 3 to 1024",
            "list the indices",
        ),
        (
            "[[0, 1, 5]]",
            "vertex 5, but there are only 5 vertices",
            "count the vertices from 0",
        ),
        ("[[0, 1, -1]]", "`faces` is -1", "from 0"),
        ("[[0, 1, 0]]", "uses vertex 0 twice", "once"),
        ("[[0, 1, 4]]", "this face has no area", "off their line"),
        ("[[0, 2, 1, 3, 4]]", "crosses itself", "in the order"),
    ] {
        check_objects(&[(&format!("{square}{faces}"), 4, cause, remedy)]);
    }
    check_objects(&[(
        "\"mesh\"\nvertices = []\nfaces = [[0, 1, 2]]",
        4,
        "vertex 0, but there are only 0 vertices",
        "count",
    )]);
}

#[test]
fn names() {
    check_objects(&[
        (
            "\"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"gras\"\n[material.grass]\n[material.water]",
            5,
            "there is no material \"gras\"",
            "did you mean \"grass\"? Or define `[material.gras]`",
        ),
        (
            "\"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"gras\"",
            5,
            "there is no material \"gras\"",
            "define `[material.gras]`",
        ),
        (
            "\"instance\"\ngroup = \"tre\"\n[[group.tree.object]]\nkind = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1",
            3,
            "there is no group \"tre\"",
            "did you mean \"tree\"?",
        ),
        (
            "\"instance\"\ngroup = \"tre\"",
            3,
            "there is no group \"tre\"",
            "[[group.tre.object]]",
        ),
        (
            "\"import\"\nfile = \"\"",
            3,
            "`file` is empty",
            "between the quotes",
        ),
        (
            "\"import\"\nfile = \"a.pdb\"\nstyle = \"balls\"",
            4,
            "`style` is \"balls\"",
            "space-filling, ball-and-stick",
        ),
        (
            "\"import\"\nfile = \"a.pdb\"\nmodel = 0",
            4,
            "`model` is 0",
            "from 1",
        ),
        (
            "\"import\"\nfile = \"a.pdb\"\naltloc = \"AB\"",
            4,
            "`altloc` is not one character",
            "\"A\"",
        ),
        (
            "\"group\"\nobject = []",
            3,
            "this group holds no object",
            "remove it",
        ),
    ]);
    // Also where no object uses the group.
    check(&[(
        "[[group.a.object]]\nkind = \"instance\"\ngroup = \"b\"",
        3,
        "there is no group \"b\"",
        "\"a\"",
    )]);
}

#[test]
fn circles_of_groups() {
    let circle = "[[group.a.object]]\nkind = \"instance\"\ngroup = \"b\"\n[[group.b.object]]\nkind = \"instance\"\ngroup = \"a\"\n";
    check(&[
        (
            circle,
            6,
            "contain each other in a circle: a -> b -> a",
            "remove one of these instances",
        ),
        (
            "[[group.a.object]]\nkind = \"instance\"\ngroup = \"a\"\n",
            3,
            "a -> a",
            "remove",
        ),
    ]);
    let used = format!("{circle}[[object]]\nkind = \"instance\"\ngroup = \"a\"\n");
    check(&[(&used, 6, "in a circle: a -> b -> a", "remove one")]);
}

#[test]
fn miette_underlines_the_value() {
    let error = refusal("[material.red]\ndiffuse = [1, 0, -2]\n");
    let mut report = String::new();
    let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor());
    handler.render_report(&mut report, &error).unwrap();
    let underlined = "2 │ diffuse = [1, 0, -2]\n   ·           ──────────";
    assert!(report.contains(underlined), "{report}");
    assert!(report.contains("write numbers at or above 0"), "{report}");
}
