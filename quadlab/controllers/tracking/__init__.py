"""From plan and state to the reference of a tick: contacts, alignment, swing feet, torso."""
