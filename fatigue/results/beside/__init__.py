"""What a result says beside the verdict: other assumptions, shear at the toe, checks beside it."""
