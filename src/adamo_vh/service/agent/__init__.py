"""Any program as the mind of a body: started, confined, heard over MCP, and scored."""
