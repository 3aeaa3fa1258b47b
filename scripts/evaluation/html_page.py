"""Self-contained HTML pages: no scripts, nothing from the network, readable by day and by night.

A picture is H x W x 3 uint8, sRGB, in RGB order.
"""

import html
import os

from evaluation import drawing

CRISP_WIDTH = 320  # pixels of narrower pictures are shown as squares

STYLE = """
:root {
  color-scheme: light dark;
  --page: #fcfcfb; --card: #f3f3f0; --ink: #1d1f21; --soft: #5d6368; --rule: #d5d6d3; --good: #1a7f58; --bad: #c03a2b;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #16181a; --card: #202326; --ink: #e4e5e3; --soft: #a0a7ac; --rule: #3a3f43; --good: #4cc38f; --bad: #ff8a78;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0 auto; max-width: 1400px; padding: 24px; background: var(--page); color: var(--ink);
  font: 15px/1.45 system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; overflow-wrap: anywhere;
}
h1 { font-size: 1.6rem; margin: 0 0 4px; }
h2 { font-size: 1.2rem; margin: 40px 0 10px; }
h3 { font-size: 1rem; margin: 22px 0 8px; }
p { margin: 6px 0; max-width: 90ch; }
small, figcaption { font-size: .85rem; font-weight: 400; }
small, figcaption, .soft { color: var(--soft); }
table { border-collapse: collapse; width: 100%; }
th, td { text-align: left; vertical-align: top; padding: 6px 18px 6px 0; border-bottom: 1px solid var(--rule); }
th { font-weight: 600; }
thead th { color: var(--soft); font-size: .85rem; }
.scroll { overflow-x: auto; overflow-wrap: normal; }
.number { text-align: right; font-variant-numeric: tabular-nums; }
.name, .number, .tight { white-space: nowrap; width: 1%; }
.best { font-weight: 700; }
.good { color: var(--good); }
.bad { color: var(--bad); }
figure { margin: 0; min-width: 0; }
img { display: block; width: 100%; height: auto; background: var(--card); }
img.crisp { image-rendering: pixelated; }
svg { display: block; width: 100%; height: auto; }
svg text { font-family: inherit !important; }
.pictures { display: grid; gap: 16px; grid-template-columns: repeat(auto-fill, minmax(min(100%, 480px), 1fr)); }
.plots { display: grid; gap: 20px 28px; grid-template-columns: repeat(auto-fill, minmax(min(100%, 380px), 1fr)); }
.wide { max-width: 640px; }
.legend { display: flex; flex-wrap: wrap; gap: 12px 40px; align-items: center; margin: 12px 0; }
.legend figure { display: flex; gap: 12px; align-items: center; max-width: 520px; }
.legend .wheel { width: 96px; flex: none; border-radius: 50%; }
.legend .bar { width: 160px; height: 14px; flex: none; }
.grid th, .grid td { border: 0; padding: 0 8px 8px 0; }
.grid tbody th { width: 7em; }
.grid td { min-width: 220px; }
.strip td { min-width: 132px; }
@media (max-width: 700px) {
  body { padding: 14px; }
  .tight { white-space: normal; }
  .grid tbody th { width: 5em; font-size: .85rem; }
  .grid td { min-width: 150px; }
  .stack thead { display: none; }
  .stack tr { display: block; border-bottom: 1px solid var(--rule); padding: 6px 0; }
  .stack th, .stack td { display: block; width: auto; border: 0; padding: 1px 0; }
  .stack th, .stack td { text-align: left; white-space: normal; }
  .stack td:not(:empty)::before { content: attr(data-head) ": "; color: var(--soft); }
}
"""


def escaped(text):
    return html.escape(str(text))


def write_page(path, title, subtitle, sections):
    """Replaces the file in one step, so that a reader sees the old page or the new one.

    title, subtitle: plain texts; sections: dict of heading -> HTML, left out where the HTML is empty.
    """
    body = "".join(
        f"<section>\n<h2>{escaped(heading)}</h2>\n{content}\n</section>\n"
        for heading, content in sections.items()
        if content
    )
    text = (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escaped(title)}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n"
        f'<header><h1>{escaped(title)}</h1><p class="soft">{escaped(subtitle)}</p></header>\n{body}</body>\n</html>\n'
    )
    beside = path.with_name(f".{path.name}.tmp.{os.getpid()}")
    try:
        beside.write_text(text, encoding="utf-8")
        os.replace(beside, path)
    finally:
        beside.unlink(missing_ok=True)


def table(heads, rows, kind=""):
    """Empty text without rows.

    heads: plain texts; rows: lists of (HTML, class) whose first cell names the row; kind: class of the table, "stack"
    where narrow screens show the cells of a row below each other.
    """
    if not rows:
        return ""
    kinds = ["number" if "number" in css else "" for _, css in rows[0]]
    top = "".join(f'<th class="{css}">{escaped(head)}</th>' for head, css in zip(heads, kinds))
    body = ""
    for (first, first_class), *cells in rows:
        body += f'<tr><th scope="row" class="{first_class}">{first}</th>'
        for head, (text, css) in zip(heads[1:], cells):
            body += f'<td class="{css}" data-head="{escaped(head)}">{text}</td>'
        body += "</tr>\n"
    content = f"<thead><tr>{top}</tr></thead>\n<tbody>\n{body}</tbody>"
    return f'<div class="scroll"><table class="{kind}">\n{content}</table></div>'


def picture_table(corner, columns, rows, kind=""):
    """A table of pictures; corner: plain text; rows: dict of name -> list of a picture or None per column."""
    cells = []
    for name, pictures in rows.items():
        images = ["" if rgb is None else image(rgb, f"{name}, {column}") for column, rgb in zip(columns, pictures)]
        cells.append([(escaped(name), ""), *((text, "") for text in images)])
    return table([corner, *columns], cells, f"grid {kind}")


def image(rgb, alt):
    crisp = ' class="crisp"' if rgb.shape[1] < CRISP_WIDTH else ""
    return f'<img{crisp} src="{drawing.data_uri(rgb)}" alt="{escaped(alt)}">'


def figure(content, caption):
    """content: HTML; caption: plain text."""
    return f"<figure>{content}<figcaption>{escaped(caption)}</figcaption></figure>\n"
