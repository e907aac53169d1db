"""The kinds of links and the laws of joints of explicit steps, each in a file of its own."""
