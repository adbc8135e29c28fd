"""Unpacks parts of a wheel: WHEEL FOLDER RULE...

The rule FROM=TO unpacks what begins with FROM to where it begins with TO; !FROM leaves it out.
Exits with ENOSPC's number when the disk is full.
"""

import errno
import os
import shutil
import sys
import zipfile


def unpack(wheel, folder, rules):
    left_out = tuple(rule[1:] for rule in rules if rule.startswith("!"))
    taken = dict(rule.split("=") for rule in rules if not rule.startswith("!"))
    unused = set(taken)
    with zipfile.ZipFile(wheel) as archive:
        for member in archive.infolist():
            start = next((s for s in taken if member.filename.startswith(s)), None)
            if start is None or member.is_dir() or member.filename.startswith(left_out):
                continue
            unused.discard(start)
            path = os.path.join(folder, taken[start] + member.filename[len(start) :])
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with archive.open(member) as source, open(path, "wb") as sink:
                shutil.copyfileobj(source, sink, 1 << 20)
    if unused:
        sys.exit(f"it has no {', '.join(sorted(unused))}")


try:
    unpack(sys.argv[1], sys.argv[2], sys.argv[3:])
except OSError as error:
    sys.exit(errno.ENOSPC if error.errno == errno.ENOSPC else str(error))
except zipfile.BadZipFile as error:
    sys.exit(str(error))
