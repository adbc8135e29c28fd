"""`run.mcap`, by the mcap library, and by a program for recordings that has its own reading of the format."""

import json
import shutil
from pathlib import Path

from conftest import called, prf
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory


class Json:
    """Of messages in JSON."""

    def decoder_for(self, encoding: str, _schema: object) -> object:
        return json.loads if encoding == "json" else None


def diagnosis(recording: Path) -> dict[str, object]:
    """The summary of the doctor, who is of another house than what wrote the file."""
    done = called("pymcap-cli", "doctor", "--strict-message-order", "--format", "jsonl", str(recording))
    assert done.stdout, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def assert_sound(recording: Path) -> None:
    found = diagnosis(recording)
    assert found["complete"] and found["messages"], found
    assert [found["errors"], found["warnings"], found["info"]] == [0, 0, 0], found


def test_the_doctor_finds_nothing(finished: Path) -> None:
    assert_sound(finished / "run.mcap")


def test_everything_is_there_for_foxglove(finished: Path) -> None:
    topics: dict[str, list[object]] = {}
    with open(finished / "run.mcap", "rb") as file:
        decoders = [DecoderFactory(), Json()]
        reader = make_reader(file, validate_crcs=True, decoder_factories=decoders)
        for schema, channel, _, decoded in reader.iter_decoded_messages():
            assert schema.name.startswith("foxglove." if schema.encoding == "protobuf" else "prf."), schema.name
            topics.setdefault(channel.topic, []).append(decoded)
        attached = {attachment.name: attachment.data for attachment in reader.iter_attachments()}
        metadata = {entry.name: entry.metadata for entry in reader.iter_metadata()}
    for kind in ["evaluation", "training"]:
        mirrors, steps = topics[f"/{kind}/mirror"], topics[f"/{kind}/step"]
        assert len(mirrors) == len(steps) == len(topics[f"/{kind}/match"]) == len(topics[f"/{kind}/template"])
        assert {(image.width, image.height, image.encoding) for image in mirrors} == {(84, 84, "mono8")}
        assert all(len(image.data) == 84 * 84 for image in mirrors)
        # The box of the match: four corners, in the picture.
        corners = [point for match in topics[f"/{kind}/match"] for points in match.points for point in points.points]
        assert corners and all(0 <= point.x <= 84 and 0 <= point.y <= 84 for point in corners)
        assert all({"action", "reward", "distance", "score", "epsilon"} <= step.keys() for step in steps)
    assert attached.keys() == {"config.toml", "goal.png"}
    assert attached["goal.png"] == (finished / "goal.png").read_bytes()
    assert metadata["prf"]["seed"] == "5"


def test_of_a_killed_run_nearly_everything_is_recovered(killed: Path, tmp_path: Path) -> None:
    recording = killed / "run.mcap"
    assert diagnosis(recording)["errors"] != 0, "the run was to be killed while it recorded"
    recovered = tmp_path / "recovered.mcap"
    called("pymcap-cli", "recover", str(recording), "--output", str(recovered))
    assert_sound(recovered)
    resumed = tmp_path / "resumed"
    shutil.copytree(killed.parent, resumed)
    prf(resumed, "train", "c.toml", "--out", "run", "--resume")
    assert_sound(resumed / "run/run.mcap")
    # What was recovered is the beginning of what an undisturbed run would have.
    assert summaries(recovered) == summaries(resumed / "run/run.mcap")[: len(summaries(recovered))] != []


def summaries(recording: Path) -> list[bytes]:
    with open(recording, "rb") as file:
        return [message.data for _, _, message in make_reader(file).iter_messages(topics="/evaluation/summary")]
