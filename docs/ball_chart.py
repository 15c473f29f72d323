#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws docs/diagrams/ball-chart.svg: the shares of a ball driver over the sphere of arm directions,
for a left arm that rests in a T-pose and hangs down when straight (docs/ALGORITHM.md).

usage: ball_chart.py OUT.svg
"""
import math
import sys

RINGS = 24  # 7.5 degrees each
SPOKES = 40
RADIUS = 170.0
COLOURS = {"front": (2, 119, 189), "back": (239, 108, 0), "left": (46, 125, 50),
           "right": (142, 36, 170)}
GAIN, TURN_COSINE, FADE_LENGTH = 8.0, -0.5, 0.5
REST_SIDE = (0.0, -1.0)  # forward, right: the T-pose of a left arm points left


def shares(angle, psi, new_chart):
    """The parts of the bend: front, back, left, right."""
    cosine = math.cos(angle)
    forward = math.sin(angle) * math.cos(psi)
    right = math.sin(angle) * math.sin(psi)
    fade = 1.0
    if new_chart:
        turn = GAIN * max(TURN_COSINE - cosine, 0.0) ** 2
        forward += turn * REST_SIDE[0]
        right += turn * REST_SIDE[1]
        if cosine < 0.0:
            t = min(math.hypot(forward, right) / FADE_LENGTH, 1.0)
            fade = t * t * (3.0 - 2.0 * t)
    length = math.hypot(forward, right)
    f, r = forward / length, right / length
    return [fade * max(x, 0.0) ** 2 for x in (f, -f, -r, r)]


def colour(parts):
    """A mix of the four colours; white where the values fade. Few levels, so that cells share a path."""
    levels = [round(part * 8) / 8 for part in parts]
    rest = max(0.0, 1.0 - sum(levels))
    mix = [rest * 255 + sum(level * rgb[i] for level, rgb in zip(levels, COLOURS.values()))
           for i in range(3)]
    return "#%02x%02x%02x" % tuple(min(255, round(c)) for c in mix)


def point(ring, spoke):
    """Angle from straight outwards; forward is up, the subject's right is on the right."""
    radius = RADIUS * ring / RINGS
    psi = 2.0 * math.pi * spoke / SPOKES
    return "%.1f %.1f" % (radius * math.sin(psi), -radius * math.cos(psi))


def sphere(new_chart):
    """The cells of the map, one path per colour."""
    paths = {}
    for ring in range(RINGS):
        for spoke in range(SPOKES):
            angle = math.pi * (ring + 0.5) / RINGS
            psi = 2.0 * math.pi * (spoke + 0.5) / SPOKES
            cell = "M%s L%s L%s L%sZ" % (point(ring, spoke), point(ring, spoke + 1),
                                         point(ring + 1, spoke + 1), point(ring + 1, spoke))
            paths.setdefault(colour(shares(angle, psi, new_chart)), []).append(cell)
    return "\n".join('<path fill="%s" stroke="%s" stroke-width="0.6" d="%s"/>' % (c, c, "".join(cells))
                     for c, cells in sorted(paths.items()))


def panel(x, title, notes, new_chart):
    """One map with its labels and marks."""
    at = RADIUS / 180.0
    marks = ['<circle class="mark" cx="%.1f" cy="0" r="5"/>' % (-90 * at),
             '<text class="small on" x="%.1f" y="-10">T-pose</text>' % (-90 * at),
             '<circle class="mark" r="5"/><text class="small on" y="-10">hangs</text>']
    if new_chart:
        marks.append('<circle class="ring" cx="%.1f" cy="0" r="7"/>' % (141.1 * at))
    else:
        marks.append('<circle class="ring" r="%.1f"/>' % RADIUS)
    sides = [("front", 0, -RADIUS - 10), ("back", 0, RADIUS + 22), ("left", -RADIUS - 26, 5),
             ("right", RADIUS + 28, 5)]
    labels = ['<text class="side" x="%.1f" y="%.1f" style="fill: rgb%s">%s</text>'
              % (sx, sy, COLOURS[name], name) for name, sx, sy in sides]
    lines = ['<text class="note" y="%d">%s</text>' % (RADIUS + 48 + 17 * i, note)
             for i, note in enumerate(notes)]
    return "\n".join(['<g transform="translate(%d 250)">' % x,
                      '<text class="title" y="%.1f">%s</text>' % (-RADIUS - 38, title),
                      sphere(new_chart), *marks, *labels, *lines, "</g>"])


STYLE = """
    text { font-family: system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, "DejaVu Sans", sans-serif; fill: #263238; text-anchor: middle; }
    .title { font-size: 14px; font-weight: 600; }
    .side { font-size: 13px; font-weight: 600; }
    .note { font-size: 11.5px; fill: #455a64; }
    .small { font-size: 11.5px; }
    .on { fill: #ffffff; }
    .mark { fill: #ffffff; stroke: #263238; stroke-width: 1.5; }
    .ring { fill: none; stroke: #d50000; stroke-width: 3; }
"""


def main(out):
    title = "Which direction of a left arm gives which value"
    svg = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 920 500" width="920" height="500" '
           'role="img" aria-label="%s">' % title,
           "<title>%s</title>" % title,
           "<desc>Two maps of the sphere of directions. The centre is the hanging arm, the rim the raised "
           "arm. Colours are the shares of front, back, left and right.</desc>",
           "<style>%s</style>" % STYLE, '<rect width="920" height="500" fill="#ffffff"/>',
           panel(235, "Direction around the straight arm",
                 ["The rim is one direction: the arm overhead (red).",
                  "All four values meet there."], False),
           panel(685, "Directions beyond 120 degrees turn to the rest side",
                 ["The rim has one value. The values fade around one direction",
                  "(red): above the other shoulder, opposite the T-pose."], True), "</svg>", ""]
    with open(out, "w", encoding="utf-8") as file:
        file.write("\n".join(svg))


if __name__ == "__main__":
    main(*sys.argv[1:])
