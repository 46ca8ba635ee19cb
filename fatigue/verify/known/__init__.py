"""Cases with known answers: closed forms, and values published in standards and papers."""
