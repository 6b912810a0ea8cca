"""Links of pages to the rest of the repository, which a forge follows and a manual has not.

A file is taken along, to be downloaded; of a folder the name remains.
"""

import re
from pathlib import Path

_LINK = re.compile(r"(?<!!)\[(?P<text>[^\]]*)\]\((?P<target>\.\./[^)#]*)[^)]*\)")


def within_manual(page: str, folder: Path, manual: Path) -> str:
    """The page, which lies in that folder of the manual, with links that its build can follow."""

    def followed(link: re.Match[str]) -> str:
        file = (folder / link["target"]).resolve()
        if file.is_relative_to(manual):
            return link[0]
        return f"[{link['text']}](path:{link['target']})" if file.is_file() else link["text"]

    return _LINK.sub(followed, page)
