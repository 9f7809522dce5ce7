#!/usr/bin/env python3
"""Converts a recording (MCAP) into one that Rerun shows (RRD), meshes included.

Rerun reads MCAP itself and maps transforms and cameras, but not the meshes of
foxglove.SceneUpdate; this script does. Packages, tried with these versions:

    pip install rerun-sdk==0.41.0 mcap==1.6.0 mcap-protobuf-support==0.6.0

Usage:

    python docs/rerun_convert.py RUN.mcap [OUT.rrd]
    rerun OUT.rrd

A recording that was cut short is converted as far as its frames are complete.
"""

import argparse
import json
import sys
from pathlib import Path

import numpy as np
import rerun as rr
from mcap.exceptions import McapError
from mcap.stream_reader import StreamReader
from mcap.records import Channel, Message, Schema
from mcap_protobuf.decoder import DecoderFactory


def messages(path):
    """Topic, frame and decoded message, in the order written, up to the end or to a cut.

    Reads the file from the front, so that it needs no summary at its end.
    """
    schemas, channels, decoders = {}, {}, {}
    factory = DecoderFactory()
    with open(path, "rb") as file:
        try:
            for record in StreamReader(file, validate_crcs=True).records:
                if isinstance(record, Schema):
                    schemas[record.id] = record
                elif isinstance(record, Channel):
                    channels[record.id] = record
                elif isinstance(record, Message):
                    channel = channels[record.channel_id]
                    if channel.message_encoding == "json":
                        yield channel.topic, record.sequence, json.loads(record.data)
                        continue
                    if channel.id not in decoders:
                        decoders[channel.id] = factory.decoder_for(
                            channel.message_encoding, schemas.get(channel.schema_id)
                        )
                    yield channel.topic, record.sequence, decoders[channel.id](record.data)
        except (McapError, EOFError) as error:
            print(f"{path}: cut short: {error!r}", file=sys.stderr)


def frames(path):
    """The messages of one complete frame after the other, as a dict by topic."""
    frame = {}
    for topic, sequence, message in messages(path):
        if topic == "/checkpoint":
            continue
        if frame.get("sequence") != sequence:
            frame = {"sequence": sequence}
        frame[topic] = message
        # The report is the last message of its frame.
        if topic == "/report":
            yield frame


def log_frame(frame):
    mark = frame["/frame"]
    rr.set_time("frame", sequence=mark.frame)
    rr.set_time("time", duration=mark.time_s)
    log_meshes("world", frame["/cloth"])
    if "/obstacles" in frame:
        log_meshes("world/obstacles", frame["/obstacles"])
    if "/tf" in frame:
        for t in frame["/tf"].transforms:
            rr.log(
                f"world/{t.child_frame_id}",
                rr.Transform3D(
                    translation=[t.translation.x, t.translation.y, t.translation.z],
                    quaternion=[t.rotation.x, t.rotation.y, t.rotation.z, t.rotation.w],
                ),
            )
    if "/camera" in frame:
        camera = frame["/camera"]
        rr.log(
            "world/camera",
            rr.Pinhole(
                image_from_camera=np.array(camera.K).reshape(3, 3),
                resolution=[camera.width, camera.height],
                camera_xyz=rr.ViewCoordinates.RDF,
            ),
        )
    log_numbers("report", frame["/report"])


def log_meshes(path, scene):
    for deletion in scene.deletions:
        rr.log(f"{path}/{deletion.id}", rr.Clear(recursive=True))
    for entity in scene.entities:
        for mesh in entity.triangles:
            points = np.array([(p.x, p.y, p.z) for p in mesh.points]).reshape(-1, 3)
            triangles = np.array(mesh.indices, dtype=np.uint32).reshape(-1, 3)
            color = [mesh.color.r, mesh.color.g, mesh.color.b, mesh.color.a]
            rr.log(
                f"{path}/{entity.id}",
                rr.Mesh3D(
                    vertex_positions=points,
                    triangle_indices=triangles,
                    vertex_normals=normals(points, triangles),
                    albedo_factor=color,
                ),
            )


def normals(points, triangles):
    """Normal of every vertex: the mean over its triangles, weighted by area."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    n = np.zeros_like(points)
    for k in range(3):
        np.add.at(n, triangles[:, k], np.cross(b - a, c - a))
    return n / np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-300)


def log_numbers(path, value):
    """Every number in the report becomes a curve over time."""
    if isinstance(value, dict):
        for key, item in value.items():
            log_numbers(f"{path}/{key}", item)
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        rr.log(path, rr.Scalars(value))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recording", type=Path, metavar="RUN.mcap")
    parser.add_argument("out", type=Path, nargs="?", metavar="OUT.rrd")
    arguments = parser.parse_args()
    out = arguments.out or arguments.recording.with_suffix(".rrd")

    rr.init("organza")
    rr.save(out)
    rr.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    n_frames = 0
    for frame in frames(arguments.recording):
        log_frame(frame)
        n_frames += 1
    print(f"{out}: {n_frames} frames")
    return 0 if n_frames else 2


if __name__ == "__main__":
    sys.exit(main())
