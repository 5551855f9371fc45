"""The commands of ``robot-bridge``, one file each; :mod:`robot_bridge.__main__` names them."""
