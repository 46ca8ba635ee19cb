"""What a job will take, said before it begins: processor time, memory, scratch files.

``size`` is what the job consists of; ``needs`` are the memory and the disk that follow from it, added up from what each
part of the program holds, and a first guess of the time; ``trial`` times the program itself on a small piece; ``spare``
is what the machine has.
"""
