"""The one place where a concrete engine, a model, a profile and a task meet."""
