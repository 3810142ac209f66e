"""OpenEnv: its wire, spoken by us, so that its clients and trainers play our rooms.

Like Gymnasium's, its rewards tell the completion that a step gained; no other player learns that.
"""
