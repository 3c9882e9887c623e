# Copyright 2026 het_ros maintainers
# SPDX-License-Identifier: Apache-2.0
"""A lifecycle node that can start itself, tells what fails and takes away what it made."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from typing import Any

from lifecycle_msgs.srv import ChangeState
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn


class StartError(RuntimeError):
    """A node that could not be configured or activated; the text says why."""


class ManagedNode(LifecycleNode):
    """The four transitions as plain methods to fill in, which may raise what they like.

    :meth:`configure` and :meth:`activate` put what undoes their work on :attr:`configured` and
    :attr:`activated`; it is called by the transition back, on a shutdown, and when they fail
    half-way.

    Attributes:
        configured: callbacks that undo :meth:`configure`, called last first.
        activated: the same for :meth:`activate`.

    Args:
        name: node name.
        **options: of rclpy's Node.
    """

    def __init__(self, name: str, **options: Any) -> None:
        super().__init__(name, **options)
        self.configured = ExitStack()
        self.activated = ExitStack()
        self._failure: Exception | None = None
        self._starting = False  # then the one who starts tells what fails
        self._guard_transitions()

    def configure(self) -> None:
        """Make what lasts until the node is cleaned up."""

    def activate(self) -> None:
        """Begin the work that lasts until the node is deactivated."""

    def start(self) -> None:
        """Configure and activate without a manager.

        Raises:
            StartError: it did not come so far.
        """
        self._starting = True
        for transition in (self.trigger_configure, self.trigger_activate):
            if transition() is not TransitionCallbackReturn.SUCCESS:
                wrong = isinstance(self._failure, ValueError)
                raise StartError(str(self._failure) if wrong else repr(self._failure))
        self._starting = False

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Unconfigured -> inactive."""
        if not self._told(self.configure, self.configured):
            return TransitionCallbackReturn.FAILURE
        return super().on_configure(state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Inactive -> active."""
        if not self._told(self.activate, self.activated):
            return TransitionCallbackReturn.FAILURE
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Active -> inactive."""
        self.activated.close()
        self.get_logger().info("deactivated: no images are taken")
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Inactive -> unconfigured."""
        self.configured.close()
        self.get_logger().info("cleaned up")
        return super().on_cleanup(state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Any state -> finalized."""
        self._undo()
        return super().on_shutdown(state)

    def destroy_node(self) -> None:
        """Undo what was made, then destroy the node."""
        self._undo()
        super().destroy_node()

    def _guard_transitions(self) -> None:
        """Let the service ``~/change_state`` refuse a transition that the state does not have.

        rclpy 7.1 raises there instead, which ends the executor and with it the process.
        """
        for service in self.services:
            if service.srv_type is ChangeState:
                service.callback = partial(self._changed_state, service.callback)

    def _changed_state(
        self,
        change: Callable[..., ChangeState.Response],
        request: ChangeState.Request,
        response: ChangeState.Response,
    ) -> ChangeState.Response:
        try:
            return change(request, response)
        except Exception as error:  # RCLError lies in a private module
            self.get_logger().warning(f"transition {request.transition.id} refused: {error}")
            response.success = False
            return response

    def _undo(self) -> None:
        self.activated.close()
        self.configured.close()

    def _told(self, work: Callable[[], None], undo: ExitStack) -> bool:
        """Whether a transition's work was done; tells why not: rclpy swallows what it raises."""
        try:
            work()
        except Exception as error:
            undo.close()
            self._failure = error
            if not self._starting:
                self.get_logger().fatal(f"{work.__name__} failed: {error!r}")
            return False
        return True
