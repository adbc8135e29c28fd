"""`tensorboard/`, by TensorBoard's own reader."""

import json
from pathlib import Path

from tensorboard.backend.event_processing.event_accumulator import EventAccumulator


def test_tensorboard_shows_the_scores_and_the_pictures(finished: Path) -> None:
    events = EventAccumulator(str(finished / "tensorboard"), size_guidance={"scalars": 0, "images": 0})
    events.Reload()
    lines = [json.loads(line) for line in (finished / "metrics.jsonl").read_text().splitlines()]
    expected = [(line["step"], line["mean_score"]) for line in lines if line["kind"] == "evaluation"]
    assert [event.step for event in events.Scalars("evaluation/score")] == [step for step, _ in expected]
    for event, (_, score) in zip(events.Scalars("evaluation/score"), expected, strict=True):
        assert abs(event.value - score) < 1e-5
    assert len(expected) > 1
    assert set(events.Tags()["images"]) == {"goal", "evaluation/mirror", "evaluation/template"}
    for tag in events.Tags()["images"]:
        pictures = events.Images(tag)
        assert pictures and all(picture.encoded_image_string.startswith(b"\x89PNG") for picture in pictures)
