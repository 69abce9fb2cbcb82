"""Studies that run from a checkout: ``make paper``. They are not installed with Raceway.

========= ======================================================================
package   responsibility
========= ======================================================================
ophel2025 the seed paper reproduced: its figures and statements on one page
========= ======================================================================
"""
