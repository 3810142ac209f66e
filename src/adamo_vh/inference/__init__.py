"""The VLM Inference Server: any model behind one interface."""
