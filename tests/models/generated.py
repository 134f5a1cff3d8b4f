"""Files that scripts of this folder write: brought up to date, or checked."""
import pathlib
import sys


def is_up_to_date(mode, file, text):
    """Whether the file has this text. With --write it is written, with --check a file that differs is named."""
    if mode == "--write":
        file.parent.mkdir(exist_ok=True)
        file.write_text(text)
        return True
    if file.exists() and file.read_text() == text:
        return True
    print(f"{file} is not what {pathlib.Path(sys.argv[0]).name} --write makes")
    return False
