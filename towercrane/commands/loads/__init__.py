"""Commands about the loads that a crane is designed for."""
