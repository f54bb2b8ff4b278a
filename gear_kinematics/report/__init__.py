"""A validation's report for people and programs: pure functions of reports."""

from gear_kinematics.report.html import to_html
from gear_kinematics.report.json import to_json
from gear_kinematics.report.junit import to_junit
from gear_kinematics.report.text import render

__all__ = ['render', 'to_html', 'to_json', 'to_junit']
