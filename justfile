# Common tasks; `just` lists them. CONTRIBUTING.md explains them.

# List the tasks
default:
    @just --list

# Build and install the program
install:
    cargo install --locked --path host

# Render the first picture
picture:
    cargo run --release -- render fixtures/glass-chess.toml -o glass-chess.png

# Check the formatting and the lints
lint:
    cargo fmt --all --check
    cargo clippy --workspace --all-targets --locked --features gridel-core/selftest -- -D warnings

# Run the ordinary tests; boards that cannot run are ignored
test:
    cargo test --workspace

# Run all tests at full length
test-full:
    GRIDEL_FULL=1 cargo test --workspace

# Check the fixtures against recorded pictures and budgets
check:
    cargo run --release -- check fixtures/check.toml

# Write the generated tables and pictures of the documents
documents:
    GRIDEL_BLESS=1 cargo test -p gridel-tests --test suite documents
    cargo test -p gridel-tests --test suite documents

# Record the figures of emulated boards
record-boards:
    GRIDEL_RECORD_BOARDS=1 cargo test -p gridel-tests --test board

# Record what accuracy costs
record-accuracy:
    cargo run --release -- accuracy fixtures/glass-chess.toml --size 80x60 \
        -o target/accuracy-glass-chess --json > fixtures/recorded/accuracy.json

# Compare with other libraries, on a quiet machine
peers:
    cd tests/peers && cargo run --release

# Write the header of the library for C
header:
    cd core/c/header && cargo run

# Build the web page
web folder="target/web":
    host/web/build "{{folder}}"

# Test the web page in a browser
web-test: web
    GRIDEL_WEB="$PWD/target/web" GRIDEL_REQUIRE_BROWSER=1 cargo test --workspace --test web -- --nocapture

# Check that the crates can be packaged
package:
    cargo package --workspace --exclude gridel-tests --no-verify --allow-dirty

# Everything that must hold before a merge
ci:
    .ci/run
