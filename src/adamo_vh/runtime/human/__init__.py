"""The virtual human: skeleton, skinned looks, and motion."""
