"""Shares one picture among the workers of a Dask cluster, and survives the loss of any of them.

    pip install "distributed>=2024"
    python render.py SCENE -o picture.png [--size 640x480] [--workers 2] [--lose-one]

Without --cluster the workers are processes on this machine; with --cluster ADDRESS they are those
of a running Dask scheduler, each of which needs `gridel` on its path. The scene is compiled once and
the blob travels; each task renders some rows and sends back a part that says which rows it has;
`gridel merge` puts them together. A part depends on nothing but the blob and the options, so a task
whose worker died is run again elsewhere, and the picture has the bytes of one machine's. --lose-one
kills a worker in the middle of the work, and compares with a picture rendered in one piece.

Exit code 1 says that the pictures differ, or that a command failed.
"""

import argparse
import os
import pathlib
import signal
import subprocess
import sys
import tempfile


def gridel(program, *arguments):
    """Runs gridel; an error shows what it said."""
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"gridel {' '.join(map(str, arguments))}: {done.stderr.strip()}")
    return done.stdout


def render_rows(program, blob, options, rows):
    """On a worker: renders rows of a picture from a blob, and returns the part's bytes."""
    with tempfile.TemporaryDirectory() as folder:
        source, part = pathlib.Path(folder, "scene.gridel"), pathlib.Path(folder, "part.png")
        source.write_bytes(blob)
        span = f"{rows[0]}..{rows[1]}"
        gridel(program, "render", source, "-o", part, "--threads", 1, "--rows", span, *options)
        return part.read_bytes()


def shares(height, count):
    """Cuts the rows of a picture in about so many parts."""
    edges = [height * share // count for share in range(count + 1)]
    return [edge for edge in zip(edges, edges[1:]) if edge[0] < edge[1]]


def show(done, total):
    """The sign of life: how many parts are there."""
    bar = "#" * (40 * done // total)
    print(f"\r{bar:40} {done} of {total} parts", end="", file=sys.stderr, flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", help="scene file or blob")
    parser.add_argument("-o", "--output", required=True, help="the picture, a .png")
    parser.add_argument("--size", default="640x480", help="width and height of the picture")
    parser.add_argument("--workers", type=int, default=2, help="processes on this machine")
    parser.add_argument("--parts", type=int, default=24, help="parts to cut the picture in")
    parser.add_argument("--cluster", help="address of a Dask scheduler to use instead")
    parser.add_argument("--gridel", default="gridel", help="the program")
    parser.add_argument("--lose-one", action="store_true", help="kill a worker on the way")
    arguments = parser.parse_args()
    if arguments.lose_one and arguments.cluster:
        parser.error("--lose-one kills processes of its own, and those of a cluster are not")
    height = int(arguments.size.split("x")[1])
    options = ["--size", arguments.size]

    from distributed import Client, LocalCluster, as_completed

    with tempfile.TemporaryDirectory() as folder:
        blob = pathlib.Path(folder, "scene.gridel")
        if pathlib.Path(arguments.scene).suffix == ".gridel":
            blob = pathlib.Path(arguments.scene)
        else:
            gridel(arguments.gridel, "build", arguments.scene, "-o", blob, "--accel", "wide")
        if arguments.cluster:
            client = Client(arguments.cluster)
        else:
            cluster = LocalCluster(
                n_workers=arguments.workers,
                threads_per_worker=1,
                processes=True,
                host="127.0.0.1",
                dashboard_address=None,
            )
            client = Client(cluster)
        with client:
            rows = shares(height, arguments.parts)
            data = client.scatter(blob.read_bytes(), broadcast=True)
            futures = {
                client.submit(render_rows, arguments.gridel, data, options, span, retries=3): span
                for span in rows
            }
            parts, lost = [], None
            for future in as_completed(futures):
                part = pathlib.Path(folder, f"rows-{futures[future][0]}.png")
                part.write_bytes(future.result())
                parts.append(part)
                show(len(parts), len(rows))
                if arguments.lose_one and lost is None and len(parts) * 3 >= len(rows):
                    lost = next(iter(client.run(os.getpid).values()))
                    os.kill(lost, signal.SIGKILL)
                    print(f"\nkilled the worker with process {lost}", file=sys.stderr)
            print(file=sys.stderr)
        if not arguments.cluster:
            cluster.close()
        print(gridel(arguments.gridel, "merge", *parts, "-o", arguments.output), end="")
        if arguments.lose_one:
            whole = pathlib.Path(folder, "whole.png")
            gridel(arguments.gridel, "render", blob, "-o", whole, *options)
            same = whole.read_bytes() == pathlib.Path(arguments.output).read_bytes()
            print("the same bytes as one machine's" if same else "NOT the bytes of one machine")
            sys.exit(0 if same else 1)


if __name__ == "__main__":
    try:
        main()
    except RuntimeError as error:
        sys.exit(f"error: {error}")
