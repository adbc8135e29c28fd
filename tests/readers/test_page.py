"""A report in headless Chromium, on a phone's width and wider ones, without scripts."""

import subprocess
import sys
from pathlib import Path

from conftest import prf

CHECK = Path(__file__).parent / "check_page.py"


def check(page: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, CHECK, page], capture_output=True, text=True, check=False)


def test_a_report_is_shown_whole_at_every_width(finished: Path, tmp_path: Path) -> None:
    page = tmp_path / "report.html"
    prf(tmp_path, "report", str(finished), "-o", str(page))
    done = check(page)
    assert done.returncode == 0, done.stdout + done.stderr
    assert done.stdout.count(": ok") == 6, done.stdout


def test_a_page_that_is_too_wide_or_fetches_something_is_found(tmp_path: Path) -> None:
    page = tmp_path / "bad.html"
    page.write_text('<!doctype html><body style="margin: 8px"><p style="width: 2000px">wide</p><img src="http://127.0.0.1:1234/picture.png">')
    done = check(page)
    assert done.returncode == 1
    for complaint in ["is 2008 px wide", "fetches http://127.0.0.1:1234/picture.png", "1 of 1 pictures are not shown"]:
        assert complaint in done.stdout, done.stdout + done.stderr
