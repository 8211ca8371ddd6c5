"""Names that a log's writer and its readers share."""

PROFILE = "quadlab"
"""Profile in the header of every trial log."""

STATE, CONTROL, LEVELS, TIMING = "/state", "/control", "/wbc_levels", "/timing"
ESTIMATE = "/estimate"
"""Named scalars at the control rate; /estimate only if the controller was not given the truth."""

TRANSFORMS, JOINT_STATES, FORCES, REFERENCE = "/tf", "/joint_states", "/forces", "/reference"
"""What moves in the 3-D view, at the scene rate."""

MODEL, TERRAIN, PLAN = "/model", "/terrain", "/plan"
"""What is drawn once."""

EVENTS = "/events"

WORLD_FRAME, PLAN_FRAME = "world", "plan"

PLAN_ATTACHMENT = "plan.npz"
TRIAL_METADATA = "trial"
PART_SUFFIX = ".part"
"""Added to the name of a log that is still being written."""

LOG_FILE = "trial.mcap"
"""Name of the log in the directory of its trial."""

CONFIG_ATTACHMENT, URDF_ATTACHMENT = "config.yaml", "robot.urdf"
