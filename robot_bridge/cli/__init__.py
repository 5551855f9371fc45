"""Commands of ``robot-bridge``, one module each; :mod:`robot_bridge.__main__` names them."""
