"""A form in the browser for the checks, runs and reports of an assessment, on this machine alone."""
