"""A window that shows what a world looks like."""

from typing import TYPE_CHECKING, Any

import numpy as np
from gymnasium.error import DependencyNotInstalled
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pygame


def import_pygame() -> Any:
    """Pygame, which only windows need."""
    try:
        import pygame
    except ImportError as error:
        message = 'pygame is not installed, run `pip install "prf-py[human]"`'
        raise DependencyNotInstalled(message) from error
    return pygame


class Window:
    """Shows frames of one size, so many a second."""

    def __init__(self, title: str, fps: int) -> None:
        self._pygame = import_pygame()
        self._title = title
        self._fps = fps
        self._screen: pygame.Surface | None = None
        self._clock = self._pygame.time.Clock()

    def show(self, frame: NDArray[np.uint8]) -> None:
        """Shows a frame of shape ``(height, width, 3)`` and waits until it is time for the next one."""
        pygame = self._pygame
        height, width, _ = frame.shape
        screen = self._screen if pygame.display.get_init() else None
        if screen is None:
            pygame.display.init()
            screen = self._screen = pygame.display.set_mode((width, height))
            pygame.display.set_caption(self._title)
        screen.blit(pygame.image.frombuffer(frame, (width, height), "RGB"), (0, 0))
        pygame.event.pump()
        self._clock.tick(self._fps)
        pygame.display.flip()

    def close(self) -> None:
        """Closes the window."""
        if self._screen is not None:
            self._screen = None
            self._pygame.display.quit()
