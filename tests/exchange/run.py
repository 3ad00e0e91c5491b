"""The tests of what floe writes for other programs: run.py FLOE."""
import formats
import matrices
import refusals

if __name__ == "__main__":
    formats.main()
    refusals.main()
    matrices.main()
