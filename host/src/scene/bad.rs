#[test]
fn show() {
    let folder = super::test_scenes::find("bad").unwrap();
    let mut files: Vec<_> = [
        folder.clone(),
        folder.join("gltf-validator"),
        folder.join("../meshes/gltf-khr-materials"),
    ]
    .iter()
    .flat_map(|f| std::fs::read_dir(f).unwrap())
    .map(|e| e.unwrap().path())
    .filter(|p| p.is_file())
    .collect();
    files.sort();
    for path in files {
        print!("{} | ", path.display());
        match super::load(&path, &Default::default()) {
            Ok(i) => println!("OK {} {:?}", i.scene.objects.len(), i.warnings),
            Err(e) => println!("ERR {e} | {}", e.remedy),
        }
    }
}
