"""Pictures of the benchmark's reports. Never imports the benchmark."""
