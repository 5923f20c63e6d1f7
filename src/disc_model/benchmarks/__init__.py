"""Speed against accuracy, and where methods fail: rival methods on the same scenes, judged by stored references."""
