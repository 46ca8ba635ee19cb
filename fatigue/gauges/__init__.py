"""Virtual strain gauges on the body, and measured strain beside what they read."""
