#!/bin/sh
# Builds the example for a board: build.sh BOARD FORMAT BLOB PROGRAM [feature,...]
# BOARD is mps2-an385 (Cortex-M3), mps2-an386 (Cortex-M4F) or host; FORMAT is fixed or f32.
set -eu
board=$1 format=$2 blob=$3 program=$4 features=${5-}
here=$(cd "$(dirname "$0")" && pwd)
cc=arm-none-eabi-gcc
case $board in
mps2-an385) target=thumbv7m-none-eabi cpu="-mcpu=cortex-m3 -mthumb" ;;
mps2-an386) target=thumbv7em-none-eabihf cpu="-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16" ;;
host) target=$(rustc -vV | sed -n 's/^host: //p') cpu= cc=cc ;;
*) echo "unknown board $board" >&2; exit 2 ;;
esac
cd "$here/.."
cargo build --quiet --release --locked --target "$target" ${features:+--no-default-features --features "$features"}
library=${CARGO_TARGET_DIR:-target}/$target/release/libgridel.a
set -- $cpu -std=c99 -Wall -Wextra -Werror -O2 -ffunction-sections -fdata-sections \
  -Iinclude "-DFORMAT=$format" "-DBLOB=\"$blob\"" example/main.c
if [ "$board" = host ]; then
  set -- "$@" "$library" -Wl,--gc-sections -lm -lpthread -ldl
else
  set -- "$@" example/start.c "$library" --specs=nano.specs --specs=rdimon.specs -Texample/board.ld -Wl,--gc-sections
fi
"$cc" "$@" -o "$program"
