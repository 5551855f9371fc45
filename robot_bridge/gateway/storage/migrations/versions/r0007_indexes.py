"""Indexes for queries on a robot's commands and tasks, and on the collection times of cones."""

from alembic import op

revision = "0007"
down_revision = "0006"


def upgrade() -> None:
    """Add them: without them a year's commands of a robot are read for each message that it acknowledges."""
    op.create_index("ix_commands_robot_sa_id", "commands", ["robot", "sa_id"])
    op.create_index("ix_commands_robot_created_at", "commands", ["robot", "created_at"])
    op.create_index("ix_queue_tasks_robot_ended_at", "queue_tasks", ["robot", "ended_at"])
    # The new ones begin with the same columns.
    op.drop_index("ix_commands_robot", table_name="commands")
    op.drop_index("ix_queue_tasks_robot", table_name="queue_tasks")
    op.create_index("ix_placements_collected_at", "placements", ["collected_at"])
