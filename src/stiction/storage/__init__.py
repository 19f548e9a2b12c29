"""Files: written whole, summed, and looked at before anything in them is believed."""
