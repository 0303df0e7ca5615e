"""From a case to its recording and summary, once or many times. Never imports studies or reports."""
