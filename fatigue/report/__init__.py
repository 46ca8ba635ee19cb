"""The pages, figures and scenes a person looks at."""
