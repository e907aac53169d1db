"""The kinds of links of explicit steps, each in a file of its own."""
