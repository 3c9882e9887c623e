# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""The page in a browser, on a recorded stream."""

from __future__ import annotations

import pytest
from operator_browser import wait


@pytest.fixture
def page(server, visit):
    page = visit(server.url)
    page.page.locator("#trackers").select_option("/tracker")
    page.wait_for_pictures()
    return page


def picks(server) -> list[tuple]:
    return [asked for asked in server.bridge.asked if asked[0] == "pick"]


def pick(server, page) -> None:
    page.drag((300, 140), (350, 260))
    wait(lambda: picks(server), "a pick")
    page.wait_for_state("TRACKING")


def canvas_changes(page) -> bool:
    """Whether the pixels on the screen move."""
    shot = "document.getElementById('live').toDataURL('image/jpeg', 0.2)"
    first = page.get(shot)
    return bool(wait(lambda: page.get(shot) != first, "moving pixels"))


def test_pixels_move_and_figures_are_shown(server, page):
    assert canvas_changes(page)
    wait(lambda: "/s" in page.text("rate") and "ms" in page.text("latency"), "figures")
    assert page.text("link") == "connected"
    assert page.state == "IDLE"


def test_a_drag_freezes_and_its_release_starts_on_the_frozen_picture(server, page):
    page.drag((300, 140), (350, 260), release=False)
    stamp = page.frozen_stamp()
    assert stamp in server.bridge.shown
    first = page.get("operatorPage.view.image.stamp")
    wait(lambda: page.get("operatorPage.view.image.stamp") != first, "newer pictures behind it")
    assert page.frozen_stamp() == stamp
    page.page.mouse.up()
    ((_, tracker, box, sent, replace),) = wait(lambda: picks(server), "a pick")
    assert (tracker, sent, replace) == ("/tracker", stamp, False)
    assert box.x == pytest.approx(300, abs=2)
    assert box.h == pytest.approx(120, abs=3)
    page.wait_for_state("TRACKING")
    wait(lambda: page.frozen_stamp() == 0, "the live picture again")
    assert ("freeze", True) in server.bridge.asked
    wait(lambda: ("freeze", False) in server.bridge.asked, "the end of the freeze")


def test_keys_alone_pick_move_size_and_start(server, page):
    page.page.locator("#live").focus()
    page.keys("p")
    x, y, w, h = wait(page.box, "a box in the middle")
    page.keys("ArrowRight", "ArrowRight", "ArrowUp", "Shift+ArrowDown")
    assert page.box() == pytest.approx([x + 2, y + 9, w, h])
    page.keys("Control+ArrowRight", "Control+ArrowDown", "Control+ArrowDown")
    assert page.box() == pytest.approx([x + 2, y + 9, w + 1, h + 2])
    assert "px at" in page.text("size")
    assert not picks(server)
    page.keys("Enter")
    wait(lambda: picks(server), "a pick")
    sent = picks(server)[0][2]
    assert [sent.x, sent.y, sent.w, sent.h] == pytest.approx([x + 2, y + 9, w + 1, h + 2])


def test_escape_lets_go(server, page):
    page.page.locator("#live").focus()
    page.keys("p", "Escape")
    assert page.frozen_stamp() == 0
    assert page.box() is None
    assert not picks(server)


def test_escape_lets_go_wherever_the_focus_is(server, page):
    page.page.get_by_role("button", name="Pick (P)").click()
    page.page.locator("#send").focus()
    page.keys("Escape")
    assert page.frozen_stamp() == 0
    assert not picks(server)


def test_edges_and_corners_move_before_the_start(server, page):
    page.page.locator("#direct").uncheck()
    page.drag((300, 140), (350, 260))
    page.drag((350, 260), (360, 280))  # the corner
    page.drag((300, 200), (290, 200))  # the left edge
    page.drag((325, 210), (335, 220))  # all of it
    assert page.box() == pytest.approx([300, 150, 70, 140], abs=4)
    assert not picks(server)
    page.page.locator("#send").click()
    wait(lambda: picks(server), "a pick")


def test_a_click_is_no_box(server, page):
    page.page.mouse.click(*page.place(320, 200))
    wait(lambda: page.frozen_stamp() == 0, "the live picture again")
    assert not picks(server)


def test_a_running_track_is_replaced_only_when_asked_for(server, page):
    pick(server, page)
    page.drag((100, 100), (150, 200))
    page.page.get_by_role("button", name="Keep the running one").click()
    assert len(picks(server)) == 1
    wait(lambda: not page.get("operatorPage.pick.sending"), "the end of the question")
    page.keys("Enter")
    page.page.get_by_role("button", name="Replace", exact=True).click()
    wait(lambda: len(picks(server)) == 2, "the second pick")
    assert picks(server)[1][-1] is True


def test_a_refusal_is_shown_as_it_is_written(server, page):
    server.bridge.refusal = "init box refused: the box is 3 x 2 px"
    page.drag((300, 140), (350, 260))
    wait(lambda: server.bridge.refusal in page.text("log"), "the refusal")


def test_lost_asks_for_help(server, page):
    pick(server, page)
    wait(
        lambda: page.get("document.getElementById('good').toDataURL().length") > 2000, "a picture"
    )
    server.bridge.state = "LOST"
    page.wait_for_state("LOST")
    assert "not seen for 2.1 s" in page.text("lost")
    page.page.get_by_role("button", name="Pick again").click()
    assert page.frozen_stamp() > 0
    page.keys("Enter")
    wait(lambda: len(picks(server)) == 2, "the second pick")
    wait(lambda: not page.page.locator("#lost").is_visible(), "no banner")


def test_reset_pause_record_and_parameters(server, page):
    pick(server, page)
    for name in ("Reset (R)", "Pause", "Go on", "Record", "Stop recording"):
        page.page.get_by_role("button", name=name).click()
    wait(lambda: ("record", False) in server.bridge.asked, "all of them")
    asked = [asked for asked in server.bridge.asked if asked[0] in ("reset", "enable", "record")]
    assert asked == [
        ("reset",), ("enable", False), ("enable", True), ("record", True), ("record", False),
    ]  # fmt: skip
    page.page.locator("summary").click()
    assert "0 to 60" in page.text("parameters")
    field = page.page.locator("input[name=lost_after]")
    field.fill("5")
    field.press("Enter")
    wait(lambda: ("set", "lost_after", 5) in server.bridge.asked, "a parameter")
    field.fill("99")
    field.press("Enter")
    assert ("set", "lost_after", 99) not in server.bridge.asked


def test_touch_draws_moves_and_starts(server, visit):
    page = visit(server.url, has_touch=True, viewport={"width": 320, "height": 640})
    page.page.locator("#trackers").select_option("/tracker")
    page.wait_for_pictures()
    cdp = page.page.context.new_cdp_session(page.page)

    def touch(kind, *at):
        points = [dict(zip("xy", page.place(*at), strict=True))] if at else []
        cdp.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    for start, end in (((280, 130), (340, 260)), ((340, 260), (360, 280))):
        touch("touchStart", *start)
        touch("touchMove", *end)
        touch("touchEnd")
    assert page.box() == pytest.approx([280, 130, 80, 150], abs=8)
    assert not picks(server)  # a finger's release starts nothing
    page.page.locator("#send").tap()
    wait(lambda: picks(server), "a pick")


def test_320_px_are_enough(server, visit):
    page = visit(server.url, viewport={"width": 320, "height": 640})
    page.wait_for_pictures()
    assert page.get("document.documentElement.scrollWidth") <= 320


def test_reload_and_another_server_go_on(server, page):
    pick(server, page)
    page.page.reload()
    page.wait_for_pictures()
    page.wait_for_state("TRACKING")
    assert page.page.locator("#trackers").input_value() == "/tracker"
    server.kill()
    wait(lambda: page.page.locator("#link").get_attribute("data-ok") == "false", "no connection")
    server.start()
    wait(lambda: page.text("link") == "connected", "connected again")
    page.wait_for_pictures()


def test_a_throttled_client_holds_up_nobody(server, page, visit):
    slow = visit(server.url)
    cdp = slow.page.context.new_cdp_session(slow.page)
    cdp.send("Network.enable")
    limits = {"offline": False, "latency": 400, "downloadThroughput": 20000}
    cdp.send("Network.emulateNetworkConditions", {**limits, "uploadThroughput": 20000})
    before = page.get("operatorPage.view.image.number")
    wait(lambda: page.get("operatorPage.view.image.number") > before + 15, "15 pictures")
    assert page.state == "IDLE"


def test_the_token_of_the_address_is_taken_and_a_wrong_one_refused(serve, visit):
    server = serve(token="secret")
    page = visit(f"{server.url}#token=secret")
    page.wait_for_pictures()
    assert "secret" not in page.page.url
    page.page.reload()
    page.wait_for_pictures()
    wrong = visit(f"{server.url}#token=guess")
    wait(lambda: "token is wrong" in wrong.text("link"), "a refusal")
    assert wrong.get("operatorPage.view.image") is None


def test_everything_has_a_name_for_a_screen_reader(server, page):
    nameless = """[...document.querySelectorAll('button, input, select, canvas')].filter(e =>
        !(e.getAttribute('aria-label') || e.innerText.trim() || e.closest('label'))).length"""
    assert page.get(nameless) == 0
    assert page.page.locator("#lost").get_attribute("role") == "alert"


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_words_stand_out_from_their_ground(server, visit, scheme):
    page = visit(server.url, color_scheme=scheme)
    for state in ("TRACKING", "COASTING", "LOST", "IDLE"):
        contrast = page.get(CONTRAST.replace("STATE", state))
        assert contrast >= 4.5, state


CONTRAST = """(() => {
  document.body.dataset.state = "STATE";
  const style = getComputedStyle(document.getElementById("state"));
  const light = (colour) => {
    const parts = colour.match(/[0-9.]+/g).slice(0, 3).map((part) => part / 255);
    const linear = parts.map((v) => (v <= 0.04 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
  };
  const [a, b] = [light(style.color), light(style.backgroundColor)];
  return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
})()"""
