"""The explorer: every parameter under a slider, and the whole motion at once, in the browser.

`server` lets only its own page in, `session` computes what a page asks for, newest request first,
`answers` says what may be asked, and `pages` holds what the browser shows.
"""
