"""The command line of PRF: ``python -m prf score goal.png frames/`` and the like.

It is the command ``prf`` in all but training, which needs libtorch. The script that ``completions`` prints is for that
command, which this package doesn't install.
"""

import signal
import sys

from prf._native import main

if __name__ == "__main__":
    # Python would note Ctrl-C and wait for the end. Unless it is ignored, it is to end the command.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(main(["python -m prf", *sys.argv[1:]]))
