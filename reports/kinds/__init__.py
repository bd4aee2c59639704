"""A file for each kind of study, which knows what a report shows of it; registry.py has a row for each."""
