"""Any MCP client as the mind of a body: it plays an episode that is recorded and scored."""
