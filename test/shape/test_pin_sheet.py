# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The drawing of the pin holes: their numbers and positions, and which are pinned."""

import math
from xml.etree import ElementTree as ET

import pytest

from gear_kinematics.kinematics.vernier import nearest_setting, pin_setting
from gear_kinematics.shape.pin_sheet import draw

SVG = '{http://www.w3.org/2000/svg}'


def parse(svg: str) -> ET.Element:
    return ET.fromstring(svg)  # noqa: S314, our own


def holes(root: ET.Element, body: str) -> list[ET.Element]:
    """The holes of a body in the order of their numbers."""
    circles = root.iter(f'{SVG}circle')
    return [circle for circle in circles if body in circle.get('class', '').split()]


def pinned(circles: list[ET.Element]) -> list[int]:
    return [k for k, circle in enumerate(circles) if 'pinned' in circle.get('class').split()]


def angles(circles: list[ET.Element], centre: tuple[float, float]) -> list[float]:
    """Turns counterclockwise from the top of the page, in [0, 1)."""
    offsets = (
        (float(circle.get('cx')) - centre[0], centre[1] - float(circle.get('cy')))
        for circle in circles
    )
    return [math.atan2(-x, y) / (2.0 * math.pi) % 1.0 for x, y in offsets]


def centre_of(circles: list[ET.Element]) -> tuple[float, float]:
    """The centre of evenly spaced holes."""
    return tuple(
        sum(float(circle.get(name)) for circle in circles) / len(circles) for name in ('cx', 'cy')
    )


def texts(root: ET.Element) -> list[str]:
    return [element.text or '' for element in root.iter(f'{SVG}text')]


def apart(first: float, second: float) -> float:
    return abs((first - second + 0.5) % 1.0 - 0.5)


@pytest.mark.parametrize('mirrored', [False, True])
@pytest.mark.parametrize(('ring_teeth', 'angle'), [(80, 0.001), (80, 2.1), (61, -1.0), (500, 4.0)])
def test_every_hole_is_where_its_number_says(ring_teeth, angle, mirrored):
    setting = nearest_setting(ring_teeth, angle)
    root = parse(draw(ring_teeth, setting, mirrored=mirrored))
    chassis, ring = holes(root, 'chassis'), holes(root, 'ring-gear')
    assert (len(chassis), len(ring)) == (ring_teeth + 2, ring_teeth + 1)
    centre = centre_of(chassis)
    sense = -1 if mirrored else 1
    for hole, turn in enumerate(angles(chassis, centre)):
        assert apart(turn, sense * hole / (ring_teeth + 2)) < 1e-5
    body = setting.chassis_hole / (ring_teeth + 2) + setting.ring_hole / (ring_teeth + 1)
    for hole, turn in enumerate(angles(ring, centre)):
        assert apart(turn, sense * (body - hole / (ring_teeth + 1))) < 1e-5


@pytest.mark.parametrize('ring_teeth', [2, 7, 80, 500])
def test_the_pinned_holes_and_no_others_lie_over_each_other(ring_teeth):
    setting = nearest_setting(ring_teeth, 1.0)
    root = parse(draw(ring_teeth, setting))
    chassis, ring = holes(root, 'chassis'), holes(root, 'ring-gear')
    assert pinned(chassis) == [setting.chassis_hole]
    assert pinned(ring) == [setting.ring_hole]
    centre = centre_of(chassis)
    together = [
        (c, r)
        for c, of_chassis in enumerate(angles(chassis, centre))
        for r, of_ring in enumerate(angles(ring, centre))
        if apart(of_chassis, of_ring) < 0.4 / ((ring_teeth + 1) * (ring_teeth + 2))
    ]
    assert together == [(setting.chassis_hole, setting.ring_hole)]


def test_the_marked_tooth_stands_at_the_turn_of_the_setting():
    setting = pin_setting(80, 23, 17, 5)
    root = parse(draw(80, setting))
    teeth = [p for p in root.iter(f'{SVG}polygon') if p.get('class') == 'tooth']
    assert len(teeth) == 80
    [other] = {tooth.get('fill') for tooth in teeth if tooth is not teeth[23]}
    assert teeth[23].get('fill') != other
    corners = [tuple(map(float, point.split(','))) for point in teeth[23].get('points').split()]
    middle = tuple(sum(values) / 4.0 for values in zip(*corners, strict=True))
    centre = centre_of(holes(root, 'chassis'))
    turn = math.atan2(centre[0] - middle[0], centre[1] - middle[1]) / (2.0 * math.pi)
    assert apart(turn, float(setting.turn)) < 1e-5


def test_the_page_says_what_to_pin_and_how_holes_are_counted():
    root = parse(draw(80, pin_setting(80, 23, 17, 5), ['3 < 4 & 5']))
    assert (root.get('width'), root.get('height')) == ('210mm', '297mm')
    words = texts(root)
    assert 'Ring hole 17 in chassis hole 5' in words
    assert '3 < 4 & 5' in words
    assert 'tooth 23' in words
    assert any(line.startswith('Seen against the z axis.') for line in words)
    assert 'Chassis holes and teeth count counterclockwise, ring holes clockwise.' in words
    assert {str(number) for number in range(82)} <= set(words)
    mirrored = texts(parse(draw(80, pin_setting(80, 23, 17, 5), mirrored=True)))
    assert any(line.startswith('Seen along the z axis.') for line in mirrored)
    assert 'Chassis holes and teeth count clockwise, ring holes counterclockwise.' in mirrored


def test_only_some_holes_are_numbered_if_there_is_no_room_for_all():
    """Every fifth of 502 holes, and always the pinned ones and their neighbours."""
    words = texts(parse(draw(500, pin_setting(500, 0, 333, 111))))
    assert len(words) < 200
    assert {'333', '111', '112', '334'} <= set(words)


def test_too_many_holes_for_a_page_are_refused():
    with pytest.raises(ValueError, match='room for 1000 teeth, not for 1001'):
        draw(1001, pin_setting(1001, 0, 0, 0))
