"""The report: reads the files of studies, draws, and never solves."""
