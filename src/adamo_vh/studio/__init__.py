"""The studio: a page on which one sees a mind in a body, talks to it, and looks at its runs again.

Everything that is shown is a *track*: a greeting that says what there is, and then messages in
order. A live room is a track that grows; a run folder is made into one by executing its record
again. So the page needs one player for both.
"""
