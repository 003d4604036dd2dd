"""Pages: reports as HTML, PDF, LaTeX, Markdown and notebooks, drawn from the documents of the verbs. No physics."""
