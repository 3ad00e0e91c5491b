"""The tests of floe export: run.py FLOE."""
import formats
import refusals

if __name__ == "__main__":
    formats.main()
    refusals.main()
