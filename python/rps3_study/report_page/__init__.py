"""The report as one page that opens from the disk: plots and an animation of the mechanism."""

from rps3_study.report_page.page import render

__all__ = ["render"]
