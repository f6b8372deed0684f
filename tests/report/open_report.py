"""Opens a report in a headless Chromium at two sizes: it must draw every figure, report no error
and ask for nothing beyond the page.

Usage: open_report.py SLUICE SCENE. Exits 77 where no Chromium is installed.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

BROWSERS = ("chromium", "chromium-browser", "google-chrome")


def browse(browser, page, size, profile, *extra):
    """What Chromium prints: the page as it stands after loading, and its log."""
    command = [browser, "--headless", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr",
               "--v=0", f"--user-data-dir={profile}", f"--window-size={size}", *extra,
               page.as_uri()]
    return subprocess.run(command, capture_output=True, text=True, timeout=240)


def main():
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        print("no Chromium is installed: skipped")
        return 77
    program, scene = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        subprocess.run([program, "run", scene, "--folder", root / "job", "--progress", "none",
                        "--threads", "1"], check=True, capture_output=True)
        page = root / "job" / "report.html"
        text = page.read_text()
        addresses = [address for address in re.findall(r"(?:src|href)=\"([^\"]*)\"", text)
                     if not address.startswith("data:")]
        assert not addresses, f"the page refers to {addresses[:3]}"
        for size in ("1280,1600", "420,900"):
            shot = root / f"{size}.png"
            seen = browse(browser, page, size, root / "profile", "--dump-dom")
            complaints = [line for line in seen.stderr.splitlines() if "CONSOLE" in line]
            assert not complaints, complaints
            assert seen.stdout.count("<svg") == text.count("<svg"), "a figure is missing"
            assert "parsererror" not in seen.stdout
            browse(browser, page, size, root / "profile", f"--screenshot={shot}")
            assert shot.stat().st_size > 10_000, "the picture of the page is blank"
        # The browser keeps its console: a page that complains is noticed.
        page.write_text(text.replace("</body>", "<script>console.error('x')</script></body>"))
        seen = browse(browser, page, "420,900", root / "profile", "--dump-dom")
        assert "CONSOLE" in seen.stderr, "errors of a page would not be seen"
    print(f"{text.count('<svg')} figures, no complaints")
    return 0


sys.exit(main())
