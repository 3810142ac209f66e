"""Draw the README's picture of the studio anew: python -m tools.studio_picture [FILE].

A live room, as a visitor has it: she is told something, does it, and the page is photographed. It
needs Chromium; where a processor draws, it takes a minute.
"""

from __future__ import annotations

import base64
import json
import sys
import time
import urllib.request
from pathlib import Path

from benchmarks.pictures import Tab, browser
from benchmarks.studio import served

from adamo_vh.studio.rooms import RoomTerms

FILE = Path(__file__).parents[1] / "docs" / "images" / "studio.jpg"
SAID = "Place the glass next to the tape"
WIDTH_PX, HEIGHT_PX = 1440, 900
QUALITY = 84
_ARGUMENTS = ("--enable-unsafe-swiftshader", "--disable-gpu")
_WAIT_S = 300.0
_SETTLE_S = 12.0
"""The camera has come to rest then, and the last picture is drawn with all pixels."""


def picture(url: str) -> bytes:
    """Let her do something, and photograph the page."""
    wish = json.dumps({"scene": "s2", "model": "baseline"}).encode()
    headers = {"content-type": "application/json"}
    asked = urllib.request.Request(f"{url}/studio/api/rooms", wish, headers)
    room = json.loads(urllib.request.urlopen(asked).read())["room"]
    with browser("chromium", _ARGUMENTS) as wire:
        tab = Tab(wire)
        screen = {"width": WIDTH_PX, "height": HEIGHT_PX, "deviceScaleFactor": 1, "mobile": False}
        tab.do("Emulation.setDeviceMetricsOverride", **screen)
        tab.do("Emulation.setScrollbarsHidden", hidden=True)
        tab.do("Page.navigate", url=f"{url}/studio/?debug&quality=full#room={room}")
        _until(tab, "globalThis.studio?.seeing?.stage?.isFull")
        tab.value("studio.seeing.chooseCamera('follow')")
        _click(tab, "Tags")
        tab.value(f"void studio.show.say({{type: 'say', text: {json.dumps(SAID)}}})")
        _until(tab, "studio.show.story.items.some(({kind}) => kind === 'answer')")
        time.sleep(_SETTLE_S)
        shot = tab.do("Page.captureScreenshot", format="jpeg", quality=QUALITY)
    return base64.b64decode(shot["data"])


def _until(tab: Tab, condition: str) -> None:
    end = time.monotonic() + _WAIT_S
    while not tab.value(f"Boolean({condition})"):
        if time.monotonic() > end:
            raise SystemExit(f"Never came true: {condition}")
        time.sleep(0.5)


def _click(tab: Tab, words: str) -> None:
    tab.value(
        "[...document.querySelectorAll('button')]"
        f".find(({{textContent}}) => textContent === {json.dumps(words)}).click()"
    )


def main() -> None:
    """Write it."""
    file = Path(sys.argv[1]) if len(sys.argv) > 1 else FILE

    def photograph(url: str) -> None:
        file.write_bytes(picture(url))

    served(photograph, resolution=RoomTerms().resolution)
    print(file)


if __name__ == "__main__":
    main()
