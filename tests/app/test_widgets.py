from types import SimpleNamespace

from geswarm.app.panels.widgets import Mirror


def test_what_the_user_has_just_chosen_is_not_overwritten():
    mirror, widget = Mirror(), SimpleNamespace(value=1)
    mirror.show(widget, 1)
    widget.value = 2  # the user; the session does not know yet
    mirror.show(widget, 1)
    assert widget.value == 2
    mirror.show(widget, 2)
    mirror.show(widget, 3)  # the session has changed
    assert widget.value == 3


def test_a_choice_that_was_refused_is_taken_back():
    mirror, widget = Mirror(), SimpleNamespace(value=1)
    mirror.show(widget, 1)
    widget.value = 2
    mirror.forget(widget)
    mirror.show(widget, 1)
    assert widget.value == 1
