#!/usr/bin/env python3
"""site_links.py FOLDER: follows every link of a site's pages, to files, anchors and pictures. None may lead outside but
those to other sites by https, which are only counted; nothing may be loaded from there."""
import os
import sys
from html.parser import HTMLParser
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    def __init__(self):
        super().__init__()
        self.links, self.anchors = [], set()

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.anchors.add(value)
            if value and (name == "href" or name == "src"):
                loads = name == "src" or (tag == "link" and dict(attributes).get("rel") in ("stylesheet", "icon"))
                self.links.append((value, loads, self.getpos()[0]))


def main(root):
    pages, problems, followed, outside = {}, [], 0, 0
    for folder, _, files in os.walk(root):
        for file in files:
            if file.endswith(".html"):
                path = os.path.normpath(os.path.join(folder, file))
                pages[path] = Page()
                with open(path, encoding="utf-8") as text:
                    pages[path].feed(text.read())
    for path, page in pages.items():
        for link, loads, line in page.links:
            parts = urlsplit(link)
            where = f"{os.path.relpath(path, root)}:{line}: {link}"
            if parts.scheme in ("http", "https") or parts.netloc:
                outside += 1
                if loads:
                    problems.append(where + " is loaded from another site")
                continue
            if parts.scheme:  # mailto, javascript, data
                continue
            followed += 1
            base = root if parts.path.startswith("/") else os.path.dirname(path)
            target = os.path.normpath(os.path.join(base, unquote(parts.path).lstrip("/"))) if parts.path else path
            if os.path.isdir(target):
                target = os.path.join(target, "index.html")
            if not os.path.exists(target):
                if os.path.basename(path) != "404.html":  # its links begin at the root of a server
                    problems.append(where + " leads to nothing")
            elif parts.fragment and target in pages and unquote(parts.fragment) not in pages[target].anchors:
                problems.append(where + " names no anchor of that page")
    for problem in problems:
        print(problem)
    print(f"{len(pages)} pages, {followed} links followed, {outside} to other sites, {len(problems)} wrong")
    return 1 if problems or not pages else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
