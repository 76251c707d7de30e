#!/usr/bin/env python3
"""Draws recordings of the terms that measured recordings ask for, alone and together, as make_scenes.py does.

    make_terms.py OUT [--count 10] [--seed 1] [--only average,weakens]
"""
import families_terms
import make_scenes

if __name__ == "__main__":
    make_scenes.draw(__doc__, families_terms.FAMILIES)
