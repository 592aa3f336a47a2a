use gridel_host::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let path = std::path::Path::new(&a[1]);
    let s = scene::load(path, &Default::default()).unwrap_or_else(|e| { eprintln!("{:?}", miette::Report::new(e)); std::process::exit(1) });
    let t = std::time::Instant::now();
    let mut o = compile::Options::default();
    o.structures = vec![gridel_core::Structure::Bvh, gridel_core::Structure::Flagged];
    if let Ok(b) = std::env::var("BITS") { o.lattice_bits = b.parse().unwrap(); }
    let c = compile::compile(&s.scene, &o).unwrap();
    eprintln!("compiled {:?} {:#?}", t.elapsed(), c.report);
    let t = std::time::Instant::now();
    let sc = c.blob.scene().unwrap_or_else(|e| panic!("{e}"));
    eprintln!("loaded {:?} stack {}", t.elapsed(), sc.stack_depth());
    let mut set = gridel_core::Settings::of(&sc);
    if let Some(w) = a.get(3) { set.width = w.parse().unwrap(); set.height = a[4].parse().unwrap(); }
    for f in gridel_core::Format::ALL { for st in [gridel_core::Structure::Bvh, gridel_core::Structure::Flagged] {
      let t = std::time::Instant::now();
      let p = render::render(&sc, &render::Job { format: f, structure: st, settings: set, rows: 0..set.height, count: std::env::var("COUNT").is_ok() }, &|| ()).unwrap();
      eprintln!("{} {} {:?} {:?}", f.name(), st.name(), t.elapsed(), p.counters);
      let mut out = std::io::BufWriter::new(std::fs::File::create(format!("{}-{}-{}.png", a[2], f.name(), st.name())).unwrap());
      let mut e = png::Encoder::new(&mut out, set.width.into(), set.height.into());
      e.set_color(png::ColorType::Rgb);
      let mut w = e.write_header().unwrap();
      use gridel_core::render::Pixel;
      let d: Vec<u8> = p.pixels.iter().flat_map(|l| gridel_core::Rgb888::encode(*l, None).0).collect();
      w.write_image_data(&d).unwrap();
    }}
}
