# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The page of `gearkin watch`; watch.js fills it with what the server sends."""

from importlib.resources import files

from gear_kinematics.kinematics import Mechanism
from gear_kinematics.report.mechanism import Drawings
from gear_kinematics.report.page import page

_BODY = """\
<header class="bar">
<h1>gearkin watch</h1>
<span id="node"></span>
<select id="nodes" aria-label="node" hidden></select>
<span id="state" class="badge">connecting</span>
<span id="message"></span>
<button type="button" id="home" disabled>Home</button>
<dl id="arm" aria-label="output angles of all actuators"></dl>
</header>
<main>
<section class="live" aria-label="mechanism and values">
<div><div id="mechanism" class="motion"></div>
<label id="margin" hidden>preload left <meter max="1" low="0.2" optimum="1"></meter></label></div>
<dl id="values"></dl>
<figure id="curve"><figcaption></figcaption>
<svg viewBox="0 0 300 100" preserveAspectRatio="none" aria-hidden="true">
<path vector-effect="non-scaling-stroke"/></svg></figure>
</section>
<section class="live"><h2>Diagnostics</h2><dl id="diagnostics"></dl></section>
<section id="drivers"><h2>Drivers: topics of type JointState</h2><dl></dl></section>
<section id="commission" hidden><details>
<summary>Commission: find the parameters of a gear with an encoder at rotor and output</summary>
<form><label>rotor <select name="rotor"></select></label>
<label>output <select name="output"></select></label>
<label>ratio, if known <input name="ratio" maxlength="40" size="8" placeholder="121"></label>
<label>output is at 0 <select name="zero"><option value="">where its encoder reads 0</option>
<option value="END">where it stands at the end</option></select></label>
<label>actuator, if it is of an arm <input name="actuator" maxlength="64" size="12"
placeholder="shoulder"></label>
<button>Start</button></form>
<div id="guide" hidden><p role="status"></p><progress></progress><dl></dl><div class="steps">
<button type="button" value="write">Write actuator.yaml</button>
<button type="button" value="apply">Apply to the running node</button>
<button type="button" value="end">End</button></div></div></details></section>
</main><dialog id="question" aria-label="home"><form method="dialog"><p></p>
<button value="">Cancel</button> <button value="home">Set it</button></form></dialog>
<div id="messages">
<p id="answer" role="status"></p>
<p id="undo" hidden><button type="button">Undo</button> <span></span></p>
</div>
"""


def watch_page(server: str) -> str:
    """Write the page of a server with an address for WebSockets, `ws://host:port`."""
    style, script = (
        files(__package__).joinpath(f'watch.{kind}').read_text('utf-8') for kind in ('css', 'js')
    )
    return page('gearkin watch', _BODY, [script], style=style, server=server)


def drawing(mechanism: Mechanism | None, module: float) -> str:
    """Write the mechanism as HTML, '' if only the ratio is known; the module is in m."""
    if mechanism is None:
        return ''
    drawings = Drawings()
    return ''.join(drawings.branches(mechanism, module)) + drawings.shapes()
