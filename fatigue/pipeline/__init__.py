"""How an assessment is carried out; each room builds on those before it.

``solve``    the files of a case -> the modal stress of a group of welds
``mission``  the records of the events -> what an event brings to every station
``count``    stations and events -> damage, life and what goes with them, in few arrays
``run``      group after group, in threads or other processes, and what an interrupted run leaves
``tables``   these arrays -> the rows of the result tables, their provenance and the warnings
``forecast`` the size of a job -> time, memory and disk that it will take
"""
