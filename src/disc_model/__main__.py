"""``python -m disc_model``: see `disc_model.cli`."""

from disc_model.cli import main

if __name__ == "__main__":
    main()
