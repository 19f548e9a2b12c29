"""Audits of random rigs: contradictions within them, and their tolerance budgets."""
